// Puts the page together: reads the data in it, fills title, diagrams and tables, and draws the shape where the browser can.

import { drawAxes } from './axes';
import { Header, PageData, readPageData } from './data';
import { fillDetails, markStep } from './details';
import { Diagrams } from './diagrams';
import { extent, ShapeModel } from './geometry';
import { drawLegend, LegendContent, legendHeight } from './legend';
import { short } from './numbers';
import { buildPanel } from './panel';
import { base64, png } from './png';
import { Stage } from './stage';
import { colour, ThemeSwitch } from './theme';
import { applyWish, readWish, View } from './view';

const get = <T extends HTMLElement>(id: string) => document.getElementById(id) as T;

/** What programs may ask of the page (karcher view --png, tests). */
interface KarcherPage {
  ready: Promise<void>;
  /** Base64 of a PNG of the picture with its legend. Rejects with a sentence where there is no picture. */
  picture: (width: number, height: number) => Promise<string>;
  view?: View;
}

const icons = {
  play: '<svg viewBox="0 0 20 20" width="14" height="14"><path d="M4 2l13 8-13 8z"/></svg>',
  pause: '<svg viewBox="0 0 20 20" width="14" height="14"><path d="M4 2h4v16H4zM12 2h4v16h-4z"/></svg>',
};

function startView(shape: NonNullable<Header['shape']>, model: ShapeModel): View {
  const g = shape.glyphs.find((set) => set.name === shape.start.glyphs);
  const first = shape.fields.find((f) => f.name === shape.start.field);
  // Where most values are small most of viridis is dark, and the shape is hard to see: then the small ones are pale.
  const e = first?.kind === 'scalar' ? extent(first.arrays.map((index) => model.data.floats(index)).slice(-1)) : undefined;
  const skew = e !== undefined && e.middle - e.low < 0.12 * (e.most - e.low);
  const inside = g !== undefined && model.hasSurface && !shape.flat && g.kind !== 'frame';
  return {
    field: first ? first.name : '',
    state: shape.states.length - 1,
    range: 'all',
    logarithmic: false,
    clipOutliers: true,
    smooth: false,
    map: skew ? 'yellow-green-blue' : 'viridis',
    surface: true,
    edges: true,
    opacity: inside ? 0.25 : 1,
    scale: 1,
    glyphs: g ? g.name : '',
    glyphSize: g?.kind === 'ellipsoid' ? 1 : 0.85,
    glyphDensity: Math.min(g?.kind === 'frame' ? 200 : shape.flat ? 450 : inside ? 700 : 300, Math.max(10, ...shape.glyphs.map((set) => model.data.header.arrays[set.reference].count))),
    clip: '',
    clipAt: 0.5,
    clipFlip: false,
    axes: true,
    trail: shape.sphere === true && shape.states.length > 2,
  };
}

class Viewer {
  readonly view: View;
  private readonly stage: Stage;
  private timer = 0;

  constructor(readonly data: PageData, private readonly model: ShapeModel, private readonly theme: ThemeSwitch, private readonly stepShown: (step: number) => void) {
    const shape = model.shape;
    const wish = readWish(location.hash);
    this.view = startView(shape, model);
    applyWish(this.view, wish);
    const notes: string[] = [];
    if (wish.field !== undefined) {
      const asked = wish.field;
      const found = shape.fields.find((f) => f.name === asked || f.label === asked);
      if (found || asked === '' || asked === 'none') this.view.field = found?.name ?? '';
      else notes.push(`There is no field "${asked}"; there are: ${shape.fields.map((f) => f.name).join(', ')}.`);
    }
    const glyphs = this.view.glyphs;
    const set = shape.glyphs.find((g) => g.name === glyphs) ?? shape.glyphs.find((g) => g.name.endsWith(` ${glyphs}`));
    if (set) this.view.glyphs = set.name;
    else if (glyphs === 'none') this.view.glyphs = '';
    else if (glyphs !== '') notes.push(`There are no glyphs of "${glyphs}"; there are: ${shape.glyphs.map((g) => g.name).join(', ') || 'none'}.`);
    if (wish.step !== undefined) {
      const at = shape.states.findIndex((s) => s.step === wish.step);
      if (at >= 0) this.view.state = at;
      else notes.push(`Load step ${wish.step} is not in this page; it has ${shape.states.map((s) => s.step).join(', ')}.`);
    }
    this.wishes = notes;
    this.stage = new Stage(get<HTMLCanvasElement>('canvas'), model, this.view);
    this.stage.onRender = () => this.decorate();
    this.player();
    if (!wish.picture) {
      buildPanel(get('controls'), model, this.view, { changed: () => this.changed(), fit: () => this.stage.fit(), save: () => void this.save() }, window.innerWidth <= 760);
    }
    new ResizeObserver(() => this.resize()).observe(get('stage'));
    this.themed();
    this.resize();
    this.stage.fit(wish.view, wish.up, false, wish.zoom);
    this.changed();
    this.stage.render();
  }

  private readonly wishes: string[];

  /** Colours of the page have changed. */
  themed(): void {
    this.stage.setTheme(colour('--stage'), colour('--edge'), colour('--border'));
    this.changed();
  }

  /** Shows a load step, if it is one of the states. */
  choose(step: number): void {
    const at = this.model.shape.states.findIndex((s) => s.step === step);
    if (at < 0) return;
    this.view.state = at;
    this.changed();
  }

  async picture(width: number, height: number): Promise<HTMLCanvasElement> {
    if (this.wishes.length) throw new Error(this.wishes.join(' '));
    const content = this.legend();
    const scale = Math.max(1, width / 1000);
    const under = Math.round((legendHeight(content) + 26) * scale);
    const wish = readWish(location.hash);
    const drawing = this.stage.picture(width, height - under, wish.picture ? () => this.stage.fit(wish.view, wish.up, true, wish.zoom) : undefined);
    const out = document.createElement('canvas');
    out.width = width;
    out.height = height;
    const context = out.getContext('2d')!;
    context.fillStyle = colour('--stage');
    context.fillRect(0, 0, width, height);
    context.drawImage(drawing, 0, 0);
    context.scale(scale, scale);
    if (this.view.axes) drawAxes(context, this.stage.camera, 10, (height - under) / scale - 96, 88, this.theme.theme === 'dark', this.model.shape.flat);
    drawLegend(context, 24, (height - under) / scale + 8, width / scale - 48, content);
    return out;
  }

  private async save(): Promise<void> {
    const canvas = await this.picture(Math.max(1600, get('stage').clientWidth * 2), Math.max(1000, get('stage').clientHeight * 2));
    const blob = await png(canvas);
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = `${(this.data.header.title || 'karcher').replace(/[^\p{L}\p{N}]+/gu, '-').replace(/^-|-$/g, '').toLowerCase() || 'karcher'}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  private resize(): void {
    const box = get('stage');
    if (box.clientWidth === 0) return;
    this.stage.resize(box.clientWidth, box.clientHeight, Math.min(2, window.devicePixelRatio || 1));
    this.drawLegend();
  }

  private changed(): void {
    const { states } = this.model.shape;
    const state = states[this.view.state];
    this.stage.update(this.view);
    get<HTMLInputElement>('step').value = String(this.view.state);
    get('step-text').textContent = states.length > 1 && state.step === 0 ? 'start' : `step ${state.step}, t = ${short(state.t)}`;
    get('player').style.display = states.length > 1 ? '' : 'none';
    this.drawLegend();
    this.note();
    this.stepShown(state.step);
  }

  private note(): void {
    const field = this.stage.field(this.view.field);
    const notes = [...this.wishes];
    if (field && field.not_finite > 0) {
      const values = field.not_finite === 1 ? 'One value of this field is not a number' : `${field.not_finite} values of this field are not numbers`;
      notes.push(`${values}; the places are shown in grey.`);
    }
    if (this.view.scale !== 1 && this.model.shape.displacement.length) notes.push(`Displacements are drawn ${short(this.view.scale, 3)} times as large.`);
    get('shown-note').textContent = notes.join(' ');
  }

  private legend(): LegendContent {
    const field = this.stage.field(this.view.field);
    return {
      field,
      range: this.stage.range(),
      map: this.view.map,
      glyphs: this.model.shape.glyphs.find((g) => g.name === this.view.glyphs),
      tinted: this.stage.tinted(),
      hasNeutral: (field?.not_finite ?? 0) > 0,
    };
  }

  private drawLegend(): void {
    const canvas = get<HTMLCanvasElement>('legend-canvas');
    const content = this.legend();
    const width = get('legend').clientWidth, height = legendHeight(content), ratio = window.devicePixelRatio || 1;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    canvas.style.height = `${height}px`;
    const context = canvas.getContext('2d')!;
    context.scale(ratio, ratio);
    drawLegend(context, 0, 0, width, content);
  }

  /** After every drawing: the tripod. */
  private decorate(): void {
    const canvas = get<HTMLCanvasElement>('axes');
    const ratio = window.devicePixelRatio || 1, size = canvas.clientWidth;
    canvas.width = canvas.height = size * ratio;
    const context = canvas.getContext('2d')!;
    context.scale(ratio, ratio);
    if (this.view.axes) drawAxes(context, this.stage.camera, 0, 0, size, this.theme.theme === 'dark', this.model.shape.flat);
  }

  private player(): void {
    const slider = get<HTMLInputElement>('step'), button = get('play');
    slider.max = String(this.model.shape.states.length - 1);
    slider.addEventListener('input', () => {
      this.view.state = Number(slider.value);
      this.changed();
    });
    const stop = () => {
      clearInterval(this.timer);
      this.timer = 0;
      button.innerHTML = icons.play;
      button.setAttribute('aria-label', 'Play');
    };
    stop();
    button.addEventListener('click', () => {
      if (this.timer) return stop();
      button.innerHTML = icons.pause;
      button.setAttribute('aria-label', 'Pause');
      const count = this.model.shape.states.length;
      if (this.view.state === count - 1) this.view.state = -1;
      const advance = () => {
        this.view.state = (this.view.state + 1) % count;
        this.changed();
      };
      advance();
      this.timer = window.setInterval(advance, Math.max(120, Math.min(500, 4000 / count)));
    });
    slider.addEventListener('pointerdown', stop);
  }
}

async function start(page: KarcherPage): Promise<void> {
  const wish = readWish(location.hash);
  let viewer: Viewer | undefined;
  let diagrams: Diagrams | undefined;
  const theme = new ThemeSwitch(get('theme'), wish.theme, () => {
    diagrams?.build();
    viewer?.themed();
  });
  let data: PageData;
  try {
    data = await readPageData(get('karcher-data').textContent ?? '');
  } catch (error) {
    get('title').textContent = 'No results';
    get('result').textContent = error instanceof Error ? error.message : String(error);
    document.body.classList.add('no-webgl');
    page.picture = () => Promise.reject(error);
    return;
  }
  const { header } = data;
  document.title = header.title || 'Karcher';
  get('title').textContent = header.title || 'Karcher';
  get('status').textContent = header.status.replace('-', ' ');
  get('status').classList.add(header.status);
  get('result').textContent = header.result;
  if (wish.picture) document.body.classList.add('picture-only');
  diagrams = new Diagrams(get('diagrams'), header, (step) => viewer?.choose(step));
  fillDetails(get('details'), header, (step) => viewer?.choose(step));
  const why = !header.shape
    ? 'No state was stored, so there is no shape to show; what is known of the run is in the diagrams and tables.'
    : !Stage.possible()
      ? 'This browser offers no WebGL, so the shape cannot be drawn here; the diagrams and tables are complete. Another browser, or hardware acceleration switched on in the settings of this one, will show it.'
      : '';
  if (why) {
    document.body.classList.add('no-webgl');
    get('no-picture').hidden = false;
    get('no-picture').textContent = why;
    page.picture = () => Promise.reject(new Error(why));
  } else {
    viewer = new Viewer(data, new ShapeModel(data, header.shape!), theme, (step) => {
      diagrams!.mark(step);
      markStep(get('details'), step);
    });
    page.view = viewer.view;
    page.picture = async (width, height) => base64(await png(await viewer!.picture(width, height)));
  }
  diagrams.build();
}

const page: KarcherPage = { ready: Promise.resolve(), picture: () => Promise.reject(new Error('The page is not ready.')) };
(window as unknown as { karcher: KarcherPage }).karcher = page;
page.ready = start(page);
