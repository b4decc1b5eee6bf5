// The data of a page: the one TypeScript description of what src/io/page_data.hpp writes.
//
// The page holds base64 of a zlib stream of: "KARCHER1" | u32 number of header bytes (little endian) | header (JSON, UTF-8) | arrays.
// Offsets of arrays count from the first byte after the header. In JSON a number that is not finite is null.

/** A block of numbers: `count` tuples of `components`. Stored component after component, every component byte plane after byte plane (low bytes first).
 *  u16: zigzag differences of successive quantised values q; value = low + q (high - low) / 65534, q = 65535 is "not a number"; low, high by component.
 *  u32: zigzag differences of successive values. f32: IEEE numbers. */
export interface ArrayInfo {
  type: 'u16' | 'u32' | 'f32';
  count: number;
  components: number;
  offset: number;
  low?: number[];
  high?: number[];
}

/** One of the numbers to colour by. `arrays` holds an array number for every state, or one for all states. */
export interface FieldInfo {
  name: string;
  label: string;
  kind: 'scalar' | 'direction';
  at: 'vertex' | 'cell';
  arrays: number[];
  /** Values that are not finite, over all states. */
  not_finite: number;
}

/** Things drawn at points: an arrow, a rod (a direction without a sense), the three directors of a rotation (unit quaternion x, y, z, w), an ellipsoid
 *  (six entries xx, yy, zz, xy, xz, yz of a symmetric matrix, whose square root gives the half axes). */
export interface GlyphInfo {
  name: string;
  kind: 'arrow' | 'rod' | 'frame' | 'ellipsoid';
  reference: number;
  displacement: number[];
  arrays: number[];
}

export interface StateInfo {
  step: number;
  t: number;
}

/** What is drawn. Vertices are shared by cells; triangles know the display cell they belong to. Polylines: vertex numbers and the length of each. */
export interface Shape {
  vertices: number;
  cells: number;
  flat: boolean;
  reference: number;
  states: StateInfo[];
  displacement: number[];
  triangles?: number;
  triangle_cells?: number;
  curves?: number;
  curve_lengths?: number;
  curve_cells?: number;
  edges?: number;
  edge_lengths?: number;
  /** The first so many edge polylines are borders and creases, drawn stronger. */
  strong_edges: number;
  /** Faces between two cells of a solid: triangles, and for each the display cell of one side; the next display cell is the other side. */
  inner?: number;
  inner_cells?: number;
  /** For every display cell a number of the cell of the solid that it belongs to (where there are inner faces). */
  solid_cells?: number;
  fields: FieldInfo[];
  glyphs: GlyphInfo[];
  start: { field: string; glyphs: string };
  /** Curves on the unit sphere: it is drawn, too. */
  sphere?: boolean;
}

export interface StepInfo {
  step: number;
  t: number | null;
  status: string;
  reason: string;
  iterations: number;
  energy: number | null;
  energies: Record<string, number | null>;
  probes: Record<string, (number | null)[]>;
  gradient_norm: number | null;
  negative_eigenvalues: number;
  factorisations: number;
  seconds: number | null;
}

export interface Iterations {
  load_step: number[];
  iteration: number[];
  energy: (number | null)[];
  gradient_norm: (number | null)[];
  step_norm: (number | null)[];
  accepted: number[];
}

export interface Header {
  format: number;
  title: string;
  version: string;
  machine: string;
  status: 'converged' | 'not-converged' | 'interrupted' | 'failed' | string;
  result: string;
  notes: string[];
  problem: string;
  facts: [string, string][];
  seconds: Record<string, number | null>;
  steps: StepInfo[];
  iterations: Iterations;
  shape?: Shape;
  arrays: ArrayInfo[];
}

export class PageData {
  private readonly cache = new Map<number, Float32Array | Uint32Array>();

  constructor(readonly header: Header, private readonly bytes: Uint8Array) {}

  /** The numbers of array `index`, tuple after tuple. */
  floats(index: number): Float32Array {
    return this.array(index) as Float32Array;
  }

  integers(index: number): Uint32Array {
    return this.array(index) as Uint32Array;
  }

  private array(index: number): Float32Array | Uint32Array {
    const known = this.cache.get(index);
    if (known) return known;
    const info = this.header.arrays[index];
    const values = info.type === 'u16' ? decode16(info, this.bytes) : decode32(info, this.bytes);
    this.cache.set(index, values);
    return values;
  }
}

function decode16(info: ArrayInfo, bytes: Uint8Array): Float32Array {
  const { count, components } = info;
  const out = new Float32Array(count * components);
  for (let c = 0; c < components; ++c) {
    const at = info.offset + 2 * count * c;
    const low = info.low![c];
    const scale = (info.high![c] - low) / 65534;
    let q = 0;
    for (let i = 0; i < count; ++i) {
      const z = bytes[at + i] | (bytes[at + count + i] << 8);
      q = (q + ((z >>> 1) ^ -(z & 1))) & 0xffff;
      out[i * components + c] = q === 0xffff ? NaN : low + q * scale;
    }
  }
  return out;
}

function decode32(info: ArrayInfo, bytes: Uint8Array): Float32Array | Uint32Array {
  const { count, components } = info;
  const out = new Uint32Array(count * components);
  for (let c = 0; c < components; ++c) {
    const at = info.offset + 4 * count * c;
    let value = 0;
    for (let i = 0; i < count; ++i) {
      const w = bytes[at + i] | (bytes[at + count + i] << 8) | (bytes[at + 2 * count + i] << 16) | (bytes[at + 3 * count + i] << 24);
      value = info.type === 'f32' ? w : (value + ((w >>> 1) ^ -(w & 1))) | 0;
      out[i * components + c] = value;
    }
  }
  return info.type === 'f32' ? new Float32Array(out.buffer) : out;
}

const magic = 'KARCHER1';

/** Reads the text of the page's data element. Throws an Error with a full sentence where it is not such data. */
export async function readPageData(base64: string): Promise<PageData> {
  const text = base64.trim();
  if (text.length === 0 || text.startsWith('@')) throw new Error('This page is the empty template: it holds no results.');
  if (typeof DecompressionStream === 'undefined') throw new Error('This browser is too old for this page: it has no DecompressionStream (every browser since 2023 has it).');
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  if (new TextDecoder().decode(bytes.subarray(0, 8)) !== magic) throw new Error('The data in this page was not written by this version of Karcher.');
  const headerBytes = new DataView(bytes.buffer).getUint32(8, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.subarray(12, 12 + headerBytes))) as Header;
  return new PageData(header, bytes.subarray(12 + headerBytes));
}
