// The controls beside the picture.

import { Controller, GUI } from 'lil-gui';
import { colourMaps } from './colours';
import { ShapeModel } from './geometry';
import { View } from './view';

export interface PanelActions {
  changed: () => void;
  fit: () => void;
  save: () => void;
}

/** A deformation scale that makes the largest displacement a quarter of the shape, rounded; 2 where the displacement is plain anyway. */
export function largestScale(model: ShapeModel): number {
  const u = model.largestDisplacement();
  if (!(u > 0)) return 2;
  const wanted = (0.25 * model.size) / u;
  if (wanted <= 2) return 2;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return Math.ceil(wanted / power) * power;
}

export function buildPanel(container: HTMLElement, model: ShapeModel, view: View, actions: PanelActions, folded: boolean): GUI {
  const { shape } = model;
  const gui = new GUI({ container, title: 'Controls', autoPlace: false });
  gui.onChange(actions.changed);
  const named = (c: Controller, id: string) => {
    c.domElement.dataset.control = id;
    return c;
  };

  const colourFolder = gui.addFolder('Colour');
  named(colourFolder.add(view, 'field', Object.fromEntries([['none', ''], ...shape.fields.map((f) => [f.label, f.name])])).name('by'), 'field');
  const map = named(colourFolder.add(view, 'map', colourMaps.map((m) => m.name)).name('map'), 'map');
  const range = named(colourFolder.add(view, 'range', { 'this step': 'step', 'all steps': 'all' }).name('range'), 'range');
  const logarithmic = named(colourFolder.add(view, 'logarithmic').name('logarithmic'), 'logarithmic');
  const outliers = named(colourFolder.add(view, 'clipOutliers').name('cap outliers'), 'clipOutliers');
  const smooth = named(colourFolder.add(view, 'smooth').name('smooth'), 'smooth');
  const follow = () => {
    const field = shape.fields.find((f) => f.name === view.field);
    for (const c of [map, range, logarithmic, outliers]) c.enable(field?.kind === 'scalar');
    smooth.enable(field?.at === 'cell');
  };
  follow();
  colourFolder.onChange(follow);

  const show = gui.addFolder('Show');
  named(show.add(view, 'surface').name(model.hasSurface ? 'surface' : 'curve'), 'surface');
  if (model.hasSurface) named(show.add(view, 'edges').name('element edges'), 'edges');
  if (model.hasSurface) named(show.add(view, 'opacity', 0.1, 1, 0.05).name('opacity'), 'opacity');
  if (!model.hasSurface && shape.displacement.length) named(show.add(view, 'trail').name('earlier states'), 'trail');
  named(show.add(view, 'axes').name('axes'), 'axes');

  if (shape.glyphs.length) {
    const glyphs = gui.addFolder('Glyphs');
    named(glyphs.add(view, 'glyphs', Object.fromEntries([['none', ''], ...shape.glyphs.map((g) => [g.name, g.name])])).name('of'), 'glyphs');
    named(glyphs.add(view, 'glyphSize', 0.2, 3, 0.05).name('size'), 'glyphSize');
    const most = Math.max(...shape.glyphs.map((g) => model.data.header.arrays[g.reference].count));
    if (most > 20) named(glyphs.add(view, 'glyphDensity', 10, Math.min(most, 4000), 1).name('number'), 'glyphDensity');
  }
  if (shape.displacement.length && !shape.sphere) {
    const deformation = gui.addFolder('Deformation');
    const most = largestScale(model);
    named(deformation.add(view, 'scale', 0, most, most / 200).name('scale'), 'scale');
  }
  const clip = gui.addFolder('Cut');
  named(clip.add(view, 'clip', { none: '', 'across x': 'x', 'across y': 'y', 'across z': 'z' }).name('plane'), 'clip');
  named(clip.add(view, 'clipAt', 0, 1, 0.005).name('at'), 'clipAt');
  named(clip.add(view, 'clipFlip').name('other side'), 'clipFlip');

  named(gui.add(actions, 'fit').name('Whole shape'), 'fit');
  named(gui.add(actions, 'save').name('Save picture'), 'save');
  if (folded) gui.close();
  return gui;
}
