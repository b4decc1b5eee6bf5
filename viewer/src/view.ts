// What the viewer shows at a moment, how it starts, and how an address (report.html#field=...&step=3) sets it.

export interface View {
  /** Name of a field, "" for the plain shape. */
  field: string;
  /** Index of the state shown. */
  state: number;
  range: 'step' | 'all';
  logarithmic: boolean;
  clipOutliers: boolean;
  /** Numbers of cells are averaged at the vertices. */
  smooth: boolean;
  map: string;
  surface: boolean;
  edges: boolean;
  opacity: number;
  scale: number;
  /** Name of a glyph set, "" for none. */
  glyphs: string;
  glyphSize: number;
  glyphDensity: number;
  clip: '' | 'x' | 'y' | 'z';
  clipAt: number;
  clipFlip: boolean;
  axes: boolean;
  /** Curves are drawn as they were at earlier states, too. */
  trail: boolean;
}

/** What may stand behind the # of the page's address. */
export interface Wish {
  view?: [number, number, number];
  up?: [number, number, number];
  field?: string;
  /** How many times nearer than what shows the whole shape. */
  zoom: number;
  step?: number;
  picture: boolean;
  theme?: 'light' | 'dark';
  set: Map<string, string>;
}

function triple(text: string | null): [number, number, number] | undefined {
  const numbers = (text ?? '').split(',').map(Number);
  return numbers.length === 3 && numbers.every(Number.isFinite) && numbers.some((x) => x !== 0) ? (numbers as [number, number, number]) : undefined;
}

export function readWish(hash: string): Wish {
  const values = new URLSearchParams(hash.replace(/^#/, ''));
  const theme = values.get('theme');
  return {
    view: triple(values.get('view')),
    up: triple(values.get('up')),
    field: values.get('field') ?? undefined,
    zoom: Number(values.get('zoom')) > 0 ? Number(values.get('zoom')) : 1,
    step: values.has('step') ? Number(values.get('step')) : undefined,
    picture: values.has('picture'),
    theme: theme === 'light' || theme === 'dark' ? theme : undefined,
    set: new Map(values),
  };
}

/** Applies the wishes whose names are members of View (edges=0, map=cividis, clip=x, ...). */
export function applyWish(view: View, wish: Wish): void {
  const members = view as unknown as Record<string, unknown>;
  for (const [key, text] of wish.set) {
    const old = members[key];
    if (key === 'field' || key === 'state' || old === undefined) continue;
    if (typeof old === 'boolean') members[key] = text !== '0' && text !== 'false';
    else if (typeof old === 'number') members[key] = Number.isFinite(Number(text)) ? Number(text) : old;
    else members[key] = text;
  }
}
