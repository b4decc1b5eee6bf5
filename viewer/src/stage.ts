// The picture: surface, tubes, element edges and glyphs of one state, drawn when something has changed.

import {
  BufferAttribute, BufferGeometry, Color, DataTexture, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, PerspectiveCamera, Scene, ShaderMaterial, SphereGeometry, Vector2, Vector3, Vector4, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { frame, goodDirection } from './camera';
import { colourMap, table } from './colours';
import { FieldInfo, GlyphInfo } from './data';
import { averaged, directionsAt, Extent, extent, Faces, onGrid, sampled, Samples, ShapeModel, spread, tubes } from './geometry';
import { glyphGeometry, largestGlyph } from './glyphs';
import { ClipPlane, glyphMaterial, lineMaterial, mapTexture, Mode, setClip, surfaceMaterial } from './shading';
import { View } from './view';

/** The numbers that the legend shows. */
export interface ShownRange {
  low: number;
  high: number;
  logarithmic: boolean;
  above: boolean;
  below: boolean;
}

export class Stage {
  readonly camera = new PerspectiveCamera(26, 1, 0.1, 100);
  private controls: OrbitControls;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly surface: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly tube: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly thin: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly strong: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly sphere: Mesh<BufferGeometry, ShaderMaterial>;
  /** Curves at earlier states. */
  private readonly trail: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  /** What is drawn of the surface: all of it, or what a cut leaves. */
  private faces: Faces;
  private glyph: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private readonly extents = new Map<string, Extent>();
  private readonly glyphSizes = new Map<string, number>();
  private readonly chosen = new Map<string, Uint32Array | Samples>();
  private tubeVertices: number[] = [];
  private tubeCells: number[] = [];
  private texture?: DataTexture;
  private textureName = '';
  private drawn = { places: '', values: '', glyphs: '', trail: '' };
  private edgeLength = 1;
  private pending = false;
  private ink = new Color(0x000000);
  private border = new Color(0x000000);
  onRender: () => void = () => undefined;

  constructor(readonly canvas: HTMLCanvasElement, readonly model: ShapeModel, private view: View) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: false, preserveDrawingBuffer: false });
    this.controls = this.makeControls();
    this.surface = new Mesh(new BufferGeometry(), surfaceMaterial());
    this.tube = new Mesh(new BufferGeometry(), surfaceMaterial());
    this.thin = new Mesh(new InstancedBufferGeometry(), lineMaterial());
    this.strong = new Mesh(new InstancedBufferGeometry(), lineMaterial());
    this.glyph = new Mesh(new InstancedBufferGeometry(), glyphMaterial());
    this.sphere = new Mesh(new SphereGeometry(model.shape.sphere ? 0.994 : 0, 96, 48), surfaceMaterial());
    (this.sphere.material.uniforms.plain.value as Vector3).set(0.78, 0.8, 0.83);
    (this.tube.material.uniforms.plain.value as Vector3).set(0.06, 0.2, 0.5);
    this.trail = new Mesh(new InstancedBufferGeometry(), lineMaterial());
    this.faces = model.faces;
    // On a flat shape the glyphs are drawn over it, whole.
    this.glyph.material.transparent = model.shape.flat;
    for (const mesh of [this.surface, this.tube, this.thin, this.strong, this.trail, this.glyph, ...(model.shape.sphere ? [this.sphere] : [])]) {
      mesh.frustumCulled = false;
      this.scene.add(mesh);
    }
    this.thin.renderOrder = 1;
    this.strong.renderOrder = 2;
    this.glyph.renderOrder = 3;
  }

  /** OrbitControls turn about the camera's upward direction at their birth. */
  private makeControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.enableDamping = false;
    controls.zoomToCursor = true;
    controls.addEventListener('change', () => this.request());
    return controls;
  }

  /** Whether this browser can draw. */
  static possible(): boolean {
    try {
      return document.createElement('canvas').getContext('webgl2') !== null;
    } catch {
      return false;
    }
  }

  /** Colours of the ground, of element edges and curves, and of borders and creases. */
  setTheme(ground: string, ink: string, border: string): void {
    this.scene.background = new Color(ground);
    this.ink = new Color(ink);
    this.border = new Color(border);
    this.request();
  }

  resize(width: number, height: number, pixelRatio: number): void {
    this.renderer.setPixelRatio(pixelRatio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.request();
  }

  up(): Vector3 {
    return this.model.shape.flat && !this.tilted() ? new Vector3(0, 1, 0) : new Vector3(0, 0, 1);
  }

  /** A flat shape with glyphs that point out of its plane is seen from the side. */
  private tilted(): boolean {
    const glyphs = this.model.shape.glyphs.find((g) => g.name === this.view.glyphs);
    return this.model.shape.flat && glyphs !== undefined && this.model.spatial(glyphs);
  }

  /** Looks from `direction` (or from where most is seen) at the whole shape: in the states from first to last, or in the one that is shown. */
  fit(direction?: [number, number, number], up?: [number, number, number], still = false, zoom = 1): void {
    const { model, view } = this;
    const last = model.positions(still ? view.state : model.shape.states.length - 1, view.scale);
    const shown = [last];
    if (model.shape.displacement.length && !still) shown.push(model.positions(0, view.scale));
    const glyphs = model.shape.glyphs.find((g) => g.name === view.glyphs);
    if (glyphs) shown.push(model.glyphPositions(glyphs, still ? view.state : 0, view.scale));
    if (model.shape.sphere) shown.push(Float32Array.from(this.sphere.geometry.getAttribute('position').array));
    const straight = direction !== undefined && direction[0] === 0 && direction[1] === 0;
    const upward = up ? new Vector3(...up) : straight ? new Vector3(0, 1, 0) : this.up();
    const flat = this.tilted() ? new Vector3(-0.28, -1, 1.25) : new Vector3(0, 0, 1);
    const from = direction ? new Vector3(...direction) : model.shape.flat ? flat : goodDirection(last, upward);
    const plane = this.clipPlane();
    const left = still && view.clip !== '' ? shown.map((x) => uncut(x, plane)) : shown;
    const target = frame(this.camera, left, from, upward, model.shape.flat || glyphs ? 1.12 : 1.08);
    this.camera.position.sub(target).divideScalar(zoom).add(target);
    this.controls.dispose();
    this.controls = this.makeControls();
    this.controls.target.copy(target);
    this.controls.update();
    this.request();
  }

  field(name: string): FieldInfo | undefined {
    return this.model.shape.fields.find((f) => f.name === name);
  }

  /** Whether arrows and rods are coloured by their direction: where the surface below them is not, or is faint. */
  tinted(): boolean {
    return this.field(this.view.field)?.kind !== 'direction' || this.view.opacity < 1 || !this.view.surface;
  }

  /** Draws soon; many requests make one drawing. */
  request(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.render();
    });
  }

  update(view: View): void {
    this.view = view;
    this.request();
  }

  /** Range of the colours at the moment; undefined where no number is shown. */
  range(): ShownRange | undefined {
    const field = this.field(this.view.field);
    if (!field || field.kind !== 'scalar') return undefined;
    const state = this.view.range === 'step' ? this.view.state : -1;
    const key = `${field.name}/${field.arrays.length === 1 ? -1 : state}`;
    let e = this.extents.get(key);
    if (!e) {
      const states = state >= 0 ? [state] : field.arrays.map((_, s) => s);
      e = extent(states.map((s) => this.model.values(field, s)));
      this.extents.set(key, e);
    }
    let low = e.low, high = e.high;
    const clip = this.view.clipOutliers && e.high > e.low;
    if (clip && e.high - e.most > 0.5 * (e.high - e.few) && e.most > e.few) high = e.most;
    if (clip && e.few - e.low > 0.5 * (e.most - e.low) && e.most > e.few) low = e.few;
    const logarithmic = this.view.logarithmic && e.high > 0;
    if (logarithmic) low = Math.max(low, e.smallestPositive, high * 1e-8);
    if (colourMap(this.view.map).diverging && !logarithmic) {
      high = Math.max(Math.abs(low), Math.abs(high));
      low = -high;
    }
    return { low, high, logarithmic, above: high < e.high, below: low > e.low && !(logarithmic && e.low <= 0) };
  }

  render(): void {
    this.refresh();
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance * 0.005, distance - 30 * this.model.size);
    this.camera.far = distance + 30 * this.model.size;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    this.onRender();
  }

  /** The picture as it is seen, at another size (finer than the screen); the caller gets a canvas of its own. `refit` may place the camera for that size. */
  picture(width: number, height: number, refit?: () => void): HTMLCanvasElement {
    const old = { width: this.canvas.clientWidth, height: this.canvas.clientHeight, ratio: this.renderer.getPixelRatio(), aspect: this.camera.aspect };
    const out = document.createElement('canvas');
    out.width = width;
    out.height = height;
    this.renderer.setPixelRatio(2);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    refit?.();
    // What was in sight stays in sight.
    const fov = this.camera.fov;
    if (!refit && this.camera.aspect < old.aspect) this.camera.fov = (360 / Math.PI) * Math.atan((Math.tan((fov * Math.PI) / 360) * old.aspect) / this.camera.aspect);
    this.render();
    const context = out.getContext('2d')!;
    context.imageSmoothingQuality = 'high';
    context.drawImage(this.canvas, 0, 0, width, height);
    this.camera.fov = fov;
    this.camera.aspect = old.aspect;
    this.renderer.setPixelRatio(old.ratio);
    this.renderer.setSize(old.width, old.height, false);
    this.render();
    return out;
  }

  private clipPlane(): ClipPlane {
    const k = ['x', 'y', 'z'].indexOf(this.view.clip);
    if (k < 0) return { normal: [0, 0, 0], offset: 1 };
    const at = this.model.low[k] + this.view.clipAt * (this.model.high[k] - this.model.low[k]);
    const sign = this.view.clipFlip ? -1 : 1;
    const normal: [number, number, number] = [0, 0, 0];
    normal[k] = sign;
    return { normal, offset: sign * at };
  }

  private refresh(): void {
    const { view, model } = this;
    const cells = model.hasInside && view.clip !== '';
    const plane = this.clipPlane();
    const places = `${model.shape.displacement.length ? view.state : 0}/${view.scale}/${cells ? `${plane.normal}/${plane.offset}` : ''}`;
    if (places !== this.drawn.places) {
      this.place(cells ? plane : undefined);
      this.drawn = { ...this.drawn, places, values: '', glyphs: '' };
    }
    const trail = view.trail ? `${view.state}/${view.scale}` : 'none';
    if (trail !== this.drawn.trail) {
      this.leaveTrail();
      this.drawn.trail = trail;
    }
    const values = `${view.field}/${view.state}/${view.smooth}`;
    if (values !== this.drawn.values) {
      this.paint();
      this.drawn.values = values;
    }
    const glyphs = `${view.glyphs}/${view.state}/${view.scale}/${view.glyphSize}/${view.glyphDensity}/${this.tinted()}`;
    if (glyphs !== this.drawn.glyphs) {
      this.plant();
      this.drawn.glyphs = glyphs;
    }
    if (this.textureName !== view.map) {
      this.texture?.dispose();
      this.texture = mapTexture(table(colourMap(view.map)));
      this.textureName = view.map;
    }
    const field = this.field(view.field);
    const range = this.range();
    const whole: ClipPlane = { normal: [0, 0, 0], offset: 1 };
    for (const mesh of [this.surface, this.tube]) {
      const u = mesh.material.uniforms;
      u.mode.value = !field ? Mode.plain : field.kind === 'scalar' ? Mode.scalar : Mode.direction;
      u.map.value = this.texture;
      if (range) {
        const bounds = range.logarithmic ? [Math.log(range.low), Math.log(range.high)] : [range.low, range.high];
        (u.range.value as Vector3).set(bounds[0], bounds[1] > bounds[0] ? bounds[1] : bounds[0] + 1, range.logarithmic ? 1 : 0);
      }
      u.opacity.value = view.opacity;
      mesh.material.transparent = view.opacity < 1;
      mesh.material.depthWrite = view.opacity >= 1 && !model.shape.flat;
      setClip(mesh.material, cells ? whole : plane);
    }
    this.surface.visible = view.surface && model.hasSurface;
    this.tube.visible = view.surface && model.curveVertices.length > 0;
    this.thin.visible = view.edges;
    this.strong.visible = view.edges;
    this.glyph.visible = view.glyphs !== '';
    setClip(this.glyph.material, plane);
    setClip(this.sphere.material, plane);
    const buffer = this.renderer.getDrawingBufferSize(new Vector2());
    const ratio = this.renderer.getPixelRatio();
    const pixels = (this.edgeLength * buffer.y) / (2 * Math.tan((this.camera.fov * Math.PI) / 360) * this.camera.position.distanceTo(this.controls.target)) / ratio;
    const faint = Math.min(0.42, Math.max(0.10, 0.03 * (pixels - 2)));
    for (const [mesh, ink, alpha, width] of [
      [this.thin, view.surface ? this.ink : this.border, faint, 1.0],
      [this.strong, this.border, 0.85, 1.6],
      [this.trail, model.shape.sphere ? this.ink : this.border, 0.5, 1.3],
    ] as const) {
      const u = mesh.material.uniforms;
      (u.ink.value as Vector4).set(ink.r, ink.g, ink.b, view.surface ? alpha : Math.max(alpha, 0.6));
      u.width.value = width * ratio;
      (u.screen.value as Vector3).set(buffer.x, buffer.y, 1);
      setClip(mesh.material, cells ? whole : plane);
    }
  }

  /** Puts everything in its place; of solids whose inside is known, cells beyond `cut` are taken away. */
  private place(cut?: ClipPlane): void {
    const { model, view } = this;
    const x = model.positions(view.state, view.scale);
    this.faces = cut ? model.cut(x, cut.normal, cut.offset) : model.faces;
    if (model.hasSurface) {
      const { position, normal } = this.faces.corner(x);
      const g = this.surface.geometry;
      g.setAttribute('position', new BufferAttribute(position, 3));
      g.setAttribute('normal', new BufferAttribute(normal, 3));
    }
    if (model.curveVertices.length) {
      const t = tubes(x, model.curveVertices, model.curveStarts, model.curveCells, 0.006 * model.size);
      const g = new BufferGeometry();
      g.setAttribute('position', new BufferAttribute(t.position, 3));
      g.setAttribute('normal', new BufferAttribute(t.normal, 3));
      g.setIndex(t.index);
      this.tubeVertices = t.vertex;
      this.tubeCells = t.cell;
      this.tube.geometry.dispose();
      this.tube.geometry = g;
    }
    this.line(this.thin, x, cut ? this.faces.cellEdges() : model.edges);
    this.line(this.strong, x, cut ? among(model.strongEdges, this.faces.triangles) : model.strongEdges);
    this.edgeLength = this.meanCellSize(x);
  }

  /** Curves as they were at up to a dozen states before the one that is shown. */
  private leaveTrail(): void {
    const { model, view } = this;
    const count = view.trail ? Math.min(12, view.state) : 0;
    const places: Float32Array[] = [], ends: number[] = [];
    for (let k = 0; k < count; ++k) {
      for (const v of model.curveSegments) ends.push(v + k * model.shape.vertices);
      places.push(model.positions(Math.round((k * view.state) / count), view.scale));
    }
    const all = new Float32Array(3 * count * model.shape.vertices);
    places.forEach((x, k) => all.set(x, 3 * k * model.shape.vertices));
    this.line(this.trail, all, Uint32Array.from(ends));
  }

  /** Side of a square as large as the mean cell, for the strength of the edges on the screen. */
  private meanCellSize(x: Float32Array): number {
    const t = this.faces.triangles;
    let area = 0;
    for (let i = 0; i < t.length; i += 3) {
      const [a, b, c] = [3 * t[i], 3 * t[i + 1], 3 * t[i + 2]];
      const u = [x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]], v = [x[c] - x[a], x[c + 1] - x[a + 1], x[c + 2] - x[a + 2]];
      area += 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    }
    return t.length ? Math.sqrt(area / Math.max(1, new Set(this.faces.cells).size)) : this.model.size;
  }

  private line(mesh: Mesh<InstancedBufferGeometry, ShaderMaterial>, x: Float32Array, ends: Uint32Array): void {
    const from = new Float32Array((3 * ends.length) / 2), to = new Float32Array((3 * ends.length) / 2);
    for (let i = 0; i < ends.length; i += 2) {
      for (let k = 0; k < 3; ++k) {
        from[(3 * i) / 2 + k] = x[3 * ends[i] + k];
        to[(3 * i) / 2 + k] = x[3 * ends[i + 1] + k];
      }
    }
    const g = new InstancedBufferGeometry();
    g.setAttribute('position', new BufferAttribute(new Float32Array([0, -0.5, 0, 1, -0.5, 0, 1, 0.5, 0, 0, 0.5, 0]), 3));
    g.setIndex([0, 1, 2, 0, 2, 3]);
    g.setAttribute('from', new InstancedBufferAttribute(from, 3));
    g.setAttribute('to', new InstancedBufferAttribute(to, 3));
    g.instanceCount = ends.length / 2;
    mesh.geometry.dispose();
    mesh.geometry = g;
  }

  private paint(): void {
    const { model, view } = this;
    const field = this.field(view.field);
    const fill = (geometry: BufferGeometry, vertices: ArrayLike<number>, cellOf: (corner: number) => number, passes: number) => {
      const scalar = new Float32Array(2 * vertices.length), direction = new Float32Array(3 * vertices.length);
      if (field) {
        const smooth = view.smooth && field.at === 'cell' && field.kind === 'scalar';
        const own = model.values(field, view.state);
        const values = smooth ? averaged(own, model.shape.vertices, vertices, cellOf, passes) : own;
        for (let i = 0; i < vertices.length; ++i) {
          const at = field.at === 'cell' && !smooth ? cellOf(i) : vertices[i];
          if (field.kind === 'scalar') {
            const fine = Number.isFinite(values[at]);
            scalar[2 * i] = fine ? values[at] : 0;
            scalar[2 * i + 1] = fine ? 1 : 0;
          } else {
            const fine = Number.isFinite(values[3 * at]) && Number.isFinite(values[3 * at + 1]) && Number.isFinite(values[3 * at + 2]);
            scalar[2 * i + 1] = fine ? 1 : 0;
            if (fine) direction.set(values.subarray(3 * at, 3 * at + 3), 3 * i);
          }
        }
      }
      geometry.setAttribute('scalar', new BufferAttribute(scalar, 2));
      geometry.setAttribute('direction', new BufferAttribute(direction, 3));
    };
    if (model.hasSurface) fill(this.surface.geometry, this.faces.triangles, (corner) => this.faces.cells[(corner / 3) | 0], 3);
    if (model.curveVertices.length) fill(this.tube.geometry, this.tubeVertices, (i) => this.tubeCells[i], 0);
  }

  private plant(): void {
    const { model, view } = this;
    const g = model.shape.glyphs.find((set) => set.name === view.glyphs);
    if (!g) return;
    const wanted = Math.round(view.glyphDensity);
    const key = `${g.name}/${wanted}`;
    let chosen = this.chosen.get(key);
    if (!chosen) {
      chosen = this.choose(g, wanted);
      this.chosen.set(key, chosen);
    }
    let x: Float32Array, values: Float32Array, which: Uint32Array;
    if (chosen instanceof Uint32Array) {
      x = model.glyphPositions(g, view.state, view.scale);
      values = model.data.floats(g.arrays[g.arrays.length === 1 ? 0 : view.state]);
      which = chosen;
    } else {
      x = chosen.places;
      values = directionsAt(chosen, model.values(this.directions(g)!, view.state));
      which = Uint32Array.from({ length: x.length / 3 }, (_, i) => i);
    }
    let largest = this.glyphSizes.get(g.name);
    if (largest === undefined) {
      largest = Math.max(...g.arrays.map((index) => largestGlyph(g.kind, model.data.floats(index))));
      this.glyphSizes.set(g.name, largest);
    }
    const spacing = this.glyphSpacing(chosen instanceof Uint32Array ? model.data.floats(g.reference) : x, which);
    const geometry = glyphGeometry(g.kind, x, values, which, (view.glyphSize * spacing) / largest, this.tinted(), [0.16, 0.17, 0.2]);
    this.glyph.geometry.dispose();
    this.glyph.geometry = geometry;
  }

  /** The directions of a set of arrows or rods at the vertices, if they are known there. */
  private directions(g: GlyphInfo): FieldInfo | undefined {
    return this.model.shape.fields.find((f) => f.kind === 'direction' && f.name === g.name);
  }

  /** Points where glyphs stand; places between the nodes where a flat shape has nodes that fill no grid. */
  private choose(g: GlyphInfo, wanted: number): Uint32Array | Samples {
    const { model } = this;
    const nodes = model.data.floats(g.reference);
    const between = model.shape.flat && model.hasSurface && model.shape.displacement.length === 0 && (g.kind === 'arrow' || g.kind === 'rod') && this.directions(g);
    if (!between || onGrid(nodes, wanted, 0.95)) return spread(nodes, wanted);
    return sampled(model.positions(0, 1), model.faces.triangles, wanted);
  }

  /** Distance between neighbours if the chosen points were spread evenly over the extent of the points. */
  private glyphSpacing(x: Float32Array, chosen: Uint32Array): number {
    const sides = [0, 1, 2].map((k) => {
      let low = Infinity, high = -Infinity;
      for (const i of chosen) (low = Math.min(low, x[3 * i + k])), (high = Math.max(high, x[3 * i + k]));
      return high > low ? high - low : 0;
    });
    sides.sort((a, b) => b - a);
    const n = Math.max(1, chosen.length);
    if (this.model.shape.flat || (this.model.hasSurface && sides[2] === 0)) return Math.sqrt((sides[0] * Math.max(sides[1], 0.02 * sides[0])) / n);
    if (!this.model.hasSurface) return Math.max(sides[0] / n, 0.05 * sides[0]);
    return Math.min(0.09 * sides[0], Math.cbrt((sides[0] * Math.max(sides[1], 0.1 * sides[0]) * Math.max(sides[2], 0.1 * sides[0])) / n));
  }
}

/** The segments whose ends both are among the vertices of the triangles. */
function among(segments: Uint32Array, triangles: Uint32Array): Uint32Array {
  const seen = new Set(triangles);
  const out: number[] = [];
  for (let i = 0; i < segments.length; i += 2) if (seen.has(segments[i]) && seen.has(segments[i + 1])) out.push(segments[i], segments[i + 1]);
  return new Uint32Array(out);
}

/** The points on this side of a plane. */
function uncut(x: Float32Array, plane: ClipPlane): Float32Array {
  const out: number[] = [];
  for (let i = 0; i < x.length; i += 3) {
    if (plane.normal[0] * x[i] + plane.normal[1] * x[i + 1] + plane.normal[2] * x[i + 2] <= plane.offset) out.push(x[i], x[i + 1], x[i + 2]);
  }
  return new Float32Array(out);
}
