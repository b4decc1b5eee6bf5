// From the data of a page to what is drawn at one state: places, normals, tubes, segments, ranges.

import { FieldInfo, GlyphInfo, PageData, Shape } from './data';

/** Faces that meet at a smaller angle than this are shaded as one smooth surface, whatever their orientation. */
const creaseCosine = Math.cos((38 * Math.PI) / 180);

/** Triangles that are drawn together, with the display cell of each. */
export class Faces {
  private readonly cornerStarts: Uint32Array;
  private readonly corners: Uint32Array;

  constructor(readonly triangles: Uint32Array, readonly cells: Uint32Array, private readonly vertices: number) {
    this.cornerStarts = new Uint32Array(vertices + 1);
    for (const v of triangles) ++this.cornerStarts[v + 1];
    for (let v = 0; v < vertices; ++v) this.cornerStarts[v + 1] += this.cornerStarts[v];
    this.corners = new Uint32Array(triangles.length);
    const fill = this.cornerStarts.slice(0, vertices);
    triangles.forEach((v, corner) => (this.corners[fill[v]++] = corner));
  }

  /** Unindexed corner positions and normals of all triangles. Normals of neighbours are averaged up to sign, so that a one-sided surface is smooth too. */
  corner(x: Float32Array): { position: Float32Array; normal: Float32Array } {
    const t = this.triangles;
    const position = new Float32Array(3 * t.length);
    const face = new Float32Array(t.length);
    const area = new Float32Array(t.length / 3);
    for (let c = 0; c < t.length; ++c) {
      const v = 3 * t[c];
      position[3 * c] = x[v];
      position[3 * c + 1] = x[v + 1];
      position[3 * c + 2] = x[v + 2];
    }
    for (let k = 0; k < t.length; k += 3) {
      const p = 3 * k;
      const ax = position[p + 3] - position[p], ay = position[p + 4] - position[p + 1], az = position[p + 5] - position[p + 2];
      const bx = position[p + 6] - position[p], by = position[p + 7] - position[p + 1], bz = position[p + 8] - position[p + 2];
      const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
      const n = Math.hypot(nx, ny, nz) || 1;
      area[k / 3] = n;
      face[k] = nx / n;
      face[k + 1] = ny / n;
      face[k + 2] = nz / n;
    }
    const normal = new Float32Array(3 * t.length);
    for (let v = 0; v < this.vertices; ++v) this.smoothAt(v, face, area, normal);
    return { position, normal };
  }

  private smoothAt(v: number, face: Float32Array, area: Float32Array, normal: Float32Array): void {
    const begin = this.cornerStarts[v];
    const end = this.cornerStarts[v + 1];
    for (let i = begin; i < end; ++i) {
      const c = this.corners[i];
      const f = c - (c % 3);
      const x = face[f], y = face[f + 1], z = face[f + 2];
      let sx = 0, sy = 0, sz = 0;
      for (let j = begin; j < end; ++j) {
        const g = this.corners[j] - (this.corners[j] % 3);
        const d = face[g] * x + face[g + 1] * y + face[g + 2] * z;
        if (Math.abs(d) < creaseCosine) continue;
        const w = d < 0 ? -area[g / 3] : area[g / 3];
        sx += w * face[g];
        sy += w * face[g + 1];
        sz += w * face[g + 2];
      }
      const n = Math.hypot(sx, sy, sz);
      normal[3 * c] = n > 0 ? sx / n : x;
      normal[3 * c + 1] = n > 0 ? sy / n : y;
      normal[3 * c + 2] = n > 0 ? sz / n : z;
    }
  }

  /** Vertex pairs of the sides of triangles that no other triangle of the same display cell has: the edges of the cells. Each once. */
  cellEdges(): Uint32Array {
    const uses = new Map<number, number>();
    const key = (a: number, b: number) => Math.min(a, b) * this.vertices + Math.max(a, b);
    const out: number[] = [];
    const drawn = new Set<number>();
    for (let begin = 0; begin < this.cells.length; ) {
      let end = begin;
      while (end < this.cells.length && this.cells[end] === this.cells[begin]) ++end;
      uses.clear();
      for (let c = 3 * begin; c < 3 * end; ++c) {
        const side = key(this.triangles[c], this.triangles[c % 3 === 2 ? c - 2 : c + 1]);
        uses.set(side, (uses.get(side) ?? 0) + 1);
      }
      for (const [side, count] of uses) {
        if (count !== 1 || drawn.has(side)) continue;
        drawn.add(side);
        out.push(Math.floor(side / this.vertices), side % this.vertices);
      }
      begin = end;
    }
    return new Uint32Array(out);
  }
}

export class ShapeModel {
  /** What is seen from outside. */
  readonly faces: Faces;
  readonly curveVertices: Uint32Array;
  readonly curveStarts: Uint32Array;
  readonly curveCells: Uint32Array;
  /** Vertex pairs along the curves. */
  readonly curveSegments: Uint32Array;
  /** Vertex pairs of the thin and of the strong element edges. */
  readonly edges: Uint32Array;
  readonly strongEdges: Uint32Array;
  readonly low: [number, number, number] = [Infinity, Infinity, Infinity];
  readonly high: [number, number, number] = [-Infinity, -Infinity, -Infinity];

  constructor(readonly data: PageData, readonly shape: Shape) {
    const none = new Uint32Array(0);
    const get = (index: number | undefined) => (index === undefined ? none : data.integers(index));
    this.faces = new Faces(get(shape.triangles), get(shape.triangle_cells), shape.vertices);
    this.curveVertices = get(shape.curves);
    this.curveStarts = startsOf(get(shape.curve_lengths));
    this.curveCells = get(shape.curve_cells);
    this.curveSegments = pairs(this.curveVertices, this.curveStarts, 0, this.curveStarts.length - 1);
    const starts = startsOf(get(shape.edge_lengths));
    const vertices = get(shape.edges);
    this.strongEdges = pairs(vertices, starts, 0, shape.strong_edges);
    this.edges = pairs(vertices, starts, shape.strong_edges, starts.length - 1);
    for (let s = 0; s < shape.states.length; ++s) {
      this.include(this.positions(s, 1));
      if (shape.displacement.length === 0) break;
    }
    for (const g of shape.glyphs) this.include(data.floats(g.reference));
  }

  private include(x: Float32Array): void {
    for (let i = 0; i < x.length; ++i) {
      if (x[i] < this.low[i % 3]) this.low[i % 3] = x[i];
      if (x[i] > this.high[i % 3]) this.high[i % 3] = x[i];
    }
  }

  get size(): number {
    return Math.hypot(this.high[0] - this.low[0], this.high[1] - this.low[1], this.high[2] - this.low[2]) || 1;
  }

  get hasSurface(): boolean {
    return this.faces.triangles.length > 0;
  }

  /** Whether a cut shows the cells inside. */
  get hasInside(): boolean {
    return this.shape.inner !== undefined;
  }

  /** What is seen from outside when the cells of a solid whose middle (mean of the corners of their faces) lies beyond the plane are taken away. */
  cut(x: Float32Array, normal: [number, number, number], offset: number): Faces {
    const { shape, data } = this;
    const inner = data.integers(shape.inner!), side = data.integers(shape.inner_cells!), solid = data.integers(shape.solid_cells!);
    const outer = this.faces;
    const height = new Float32Array(solid.reduce((most, cell) => Math.max(most, cell), 0) + 1), count = new Uint32Array(height.length);
    const add = (cell: number, triangles: Uint32Array, t: number) => {
      for (let k = 0; k < 3; ++k) {
        const v = 3 * triangles[3 * t + k];
        height[cell] += normal[0] * x[v] + normal[1] * x[v + 1] + normal[2] * x[v + 2];
      }
      count[cell] += 3;
    };
    for (let t = 0; t < outer.cells.length; ++t) add(solid[outer.cells[t]], outer.triangles, t);
    for (let t = 0; t < side.length; ++t) {
      add(solid[side[t]], inner, t);
      add(solid[side[t] + 1], inner, t);
    }
    const stays = (displayCell: number) => height[solid[displayCell]] <= offset * count[solid[displayCell]];
    const triangles: number[] = [], cells: number[] = [];
    const take = (from: Uint32Array, t: number, displayCell: number) => {
      triangles.push(from[3 * t], from[3 * t + 1], from[3 * t + 2]);
      cells.push(displayCell);
    };
    for (let t = 0; t < outer.cells.length; ++t) if (stays(outer.cells[t])) take(outer.triangles, t, outer.cells[t]);
    for (let t = 0; t < side.length; ++t) {
      const first = stays(side[t]);
      if (first !== stays(side[t] + 1)) take(inner, t, first ? side[t] : side[t] + 1);
    }
    return new Faces(new Uint32Array(triangles), new Uint32Array(cells), shape.vertices);
  }

  /** Places of the vertices at a state, with displacements multiplied by `scale`. */
  positions(state: number, scale: number): Float32Array {
    return moved(this.data.floats(this.shape.reference), this.shape.displacement.length ? this.data.floats(this.shape.displacement[state]) : undefined, scale);
  }

  glyphPositions(g: GlyphInfo, state: number, scale: number): Float32Array {
    return moved(this.data.floats(g.reference), g.displacement.length ? this.data.floats(g.displacement[state]) : undefined, scale);
  }

  /** Whether the glyphs of a set point out of the plane of a flat shape. */
  spatial(g: GlyphInfo): boolean {
    if (g.kind === 'frame') return true;
    if (g.kind === 'ellipsoid') return false;
    return g.arrays.some((index) => {
      const v = this.data.floats(index);
      for (let i = 0; i < v.length; i += 3) if (Math.abs(v[i + 2]) > 0.1 * Math.hypot(v[i], v[i + 1])) return true;
      return false;
    });
  }

  /** Largest displacement over all states. */
  largestDisplacement(): number {
    let largest = 0;
    for (const index of this.shape.displacement) {
      const u = this.data.floats(index);
      for (let i = 0; i < u.length; i += 3) largest = Math.max(largest, u[i] ** 2 + u[i + 1] ** 2 + u[i + 2] ** 2);
    }
    return Math.sqrt(largest);
  }

  values(field: FieldInfo, state: number): Float32Array {
    return this.data.floats(field.arrays[field.arrays.length === 1 ? 0 : state]);
  }
}

/** Values of cells spread to the vertices: means of the cells around a vertex, then of the triangles around it a few times over, since the vertices inside a
 *  cell see that cell only. What is not finite is left out. */
export function averaged(values: Float32Array, vertices: number, triangles: ArrayLike<number>, cellOf: (corner: number) => number, passes: number): Float32Array {
  const means = (at: (corner: number) => number) => {
    const sum = new Float32Array(vertices), count = new Float32Array(vertices);
    for (let i = 0; i < triangles.length; ++i) {
      const v = at(i);
      if (!Number.isFinite(v)) continue;
      sum[triangles[i]] += v;
      ++count[triangles[i]];
    }
    return sum.map((s, i) => s / count[i]);
  };
  let out = means((i) => values[cellOf(i)]);
  for (let k = 0; k < passes; ++k) {
    const old = out;
    out = means((i) => {
      const c = i - (i % 3);
      return (old[triangles[c]] + old[triangles[c + 1]] + old[triangles[c + 2]]) / 3;
    });
  }
  return out;
}

function moved(reference: Float32Array, displacement: Float32Array | undefined, scale: number): Float32Array {
  if (!displacement) return reference;
  const x = new Float32Array(reference.length);
  for (let i = 0; i < x.length; ++i) x[i] = reference[i] + scale * displacement[i];
  return x;
}

function startsOf(lengths: Uint32Array): Uint32Array {
  const starts = new Uint32Array(lengths.length + 1);
  for (let i = 0; i < lengths.length; ++i) starts[i + 1] = starts[i] + lengths[i];
  return starts;
}

function pairs(vertices: Uint32Array, starts: Uint32Array, begin: number, end: number): Uint32Array {
  const out: number[] = [];
  for (let p = begin; p < end; ++p) {
    for (let i = starts[p] + 1; i < starts[p + 1]; ++i) out.push(vertices[i - 1], vertices[i]);
  }
  return new Uint32Array(out);
}

/** Extent of a scalar field, leaving out what is not finite; `most` is exceeded by one value in a hundred, `middle` by half of them. */
export interface Extent {
  low: number;
  high: number;
  few: number;
  middle: number;
  most: number;
  smallestPositive: number;
}

export function extent(arrays: Float32Array[]): Extent {
  let low = Infinity, high = -Infinity, smallestPositive = Infinity;
  const sample: number[] = [];
  for (const values of arrays) {
    const stride = Math.max(1, Math.floor(values.length / 20000));
    for (let i = 0; i < values.length; ++i) {
      const v = values[i];
      if (!Number.isFinite(v)) continue;
      if (v < low) low = v;
      if (v > high) high = v;
      if (v > 0 && v < smallestPositive) smallestPositive = v;
      if (i % stride === 0) sample.push(v);
    }
  }
  if (low > high) return { low: 0, high: 1, few: 0, middle: 0.5, most: 1, smallestPositive: 1e-3 };
  sample.sort((a, b) => a - b);
  const quantile = (q: number) => sample[Math.min(sample.length - 1, Math.floor(q * sample.length))];
  return { low, high, few: quantile(0.01), middle: quantile(0.5), most: quantile(0.99), smallestPositive: Number.isFinite(smallestPositive) ? smallestPositive : 1e-3 };
}

/** Tubes around polylines. Rings stand on the mean direction of the two segments at a vertex, also across the cells that share it. */
export function tubes(x: Float32Array, vertices: Uint32Array, starts: Uint32Array, cells: Uint32Array, radius: number, sides = 12) {
  const direction = new Map<number, [number, number, number]>();
  for (let p = 0; p + 1 < starts.length; ++p) {
    for (let i = starts[p] + 1; i < starts[p + 1]; ++i) {
      const a = vertices[i - 1], b = vertices[i];
      const d = [0, 1, 2].map((k) => x[3 * b + k] - x[3 * a + k]);
      const n = Math.hypot(d[0], d[1], d[2]) || 1;
      for (const v of [a, b]) {
        const sum = direction.get(v) ?? [0, 0, 0];
        const s = sum[0] * d[0] + sum[1] * d[1] + sum[2] * d[2] < 0 ? -1 / n : 1 / n;
        direction.set(v, [sum[0] + s * d[0], sum[1] + s * d[1], sum[2] + s * d[2]]);
      }
    }
  }
  const position: number[] = [], normal: number[] = [], vertex: number[] = [], cell: number[] = [], index: number[] = [];
  let ring = 0;
  for (let p = 0; p + 1 < starts.length; ++p) {
    let e: number[] | undefined;
    let last: number[] | undefined;
    for (let i = starts[p]; i < starts[p + 1]; ++i) {
      const v = vertices[i];
      let d: number[] = [...direction.get(v)!];
      const n = Math.hypot(d[0], d[1], d[2]) || 1;
      const along = last ? d[0] * last[0] + d[1] * last[1] + d[2] * last[2] : 1;
      d = d.map((c) => (along < 0 ? -c : c) / n);
      last = d;
      if (!e) e = Math.abs(d[2]) < 0.8 ? [0, 0, 1] : [1, 0, 0];
      const dot = e[0] * d[0] + e[1] * d[1] + e[2] * d[2];
      e = e.map((c, k) => c - dot * d[k]);
      const m = Math.hypot(e[0], e[1], e[2]) || 1;
      e = e.map((c) => c / m);
      const f = [d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]];
      for (let s = 0; s < sides; ++s) {
        const c = Math.cos((2 * Math.PI * s) / sides), q = Math.sin((2 * Math.PI * s) / sides);
        for (let k = 0; k < 3; ++k) {
          const o = c * e[k] + q * f[k];
          normal.push(o);
          position.push(x[3 * v + k] + radius * o);
        }
        vertex.push(v);
        cell.push(cells[p]);
        if (i > starts[p]) {
          const a = ring - sides + s, b = ring - sides + ((s + 1) % sides);
          index.push(a, b, a + sides, b, b + sides, a + sides);
        }
      }
      ring += sides;
    }
  }
  return { position: new Float32Array(position), normal: new Float32Array(normal), vertex, cell, index };
}

/** An evenly spread subset of points, about `wanted` of them: on a grid where the points fill a square or a box, else points in order where none is nearer
 *  than a spacing, which is found by bisection. */
export function spread(x: Float32Array, wanted: number): Uint32Array {
  const n = x.length / 3;
  if (n <= wanted) return Uint32Array.from({ length: n }, (_, i) => i);
  const regular = onGrid(x, wanted, 0.7);
  if (regular) return regular;
  let size = 0;
  for (let k = 0; k < 3; ++k) {
    let low = Infinity, high = -Infinity;
    for (let i = k; i < x.length; i += 3) (low = Math.min(low, x[i])), (high = Math.max(high, x[i]));
    size = Math.max(size, high - low);
  }
  let small = 0, large = size || 1;
  let best = Uint32Array.from({ length: wanted }, (_, i) => Math.floor((i * n) / wanted));
  for (let round = 0; round < 12; ++round) {
    const h = 0.5 * (small + large);
    const kept = sieve(x, h, wanted);
    if (kept.length > wanted) small = h;
    else {
      large = h;
      best = Uint32Array.from(kept);
    }
  }
  return best;
}

/** The points nearest to the places of a grid from border to border, for the grid of 0.6 to 1 times `wanted` places that lies closest to the points; nothing where
 *  the points fill a smaller part of such a grid than `filled`. */
export function onGrid(x: Float32Array, wanted: number, filled: number): Uint32Array | undefined {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < x.length; ++i) (low[i % 3] = Math.min(low[i % 3], x[i])), (high[i % 3] = Math.max(high[i % 3], x[i]));
  const extent = [0, 1, 2].map((k) => high[k] - low[k]);
  const longest = Math.max(...extent), wide = [0, 1, 2].filter((k) => extent[k] > 1e-6 * longest);
  if (wide.length === 0) return undefined;
  const tried = new Set<string>();
  let best: Uint32Array | undefined, least = Infinity;
  for (let along = 2; along <= wanted; ++along) {
    const cells = [0, 1, 2].map((k) => (wide.includes(k) ? Math.max(1, Math.round((along * extent[k]) / longest)) : 0));
    const places = cells.reduce((product, m) => product * (m + 1), 1);
    if (places > 1.3 * wanted) break;
    if (places < 0.6 * wanted || tried.has(cells.join())) continue;
    tried.add(cells.join());
    const nearest = new Map<number, [number, number]>();
    for (let i = 0; 3 * i < x.length; ++i) {
      let key = 0, far = 0;
      for (const k of wide) {
        const at = ((x[3 * i + k] - low[k]) / extent[k]) * cells[k], to = Math.round(at);
        key = key * (cells[k] + 1) + to;
        far = Math.max(far, Math.abs(at - to));
      }
      const known = nearest.get(key);
      if (!known || far < known[1] - 1e-6) nearest.set(key, [i, far]);
    }
    const close = [...nearest.values()].filter(([, far]) => far < 0.3);
    if (close.length < filled * places || close.length > wanted) continue;
    const off = close.reduce((sum, [, far]) => sum + far, 0) / close.length + 0.1 * (1 - close.length / wanted);
    if (off < least) {
      least = off;
      best = Uint32Array.from(close.map(([i]) => i));
    }
  }
  return best;
}

function sieve(x: Float32Array, h: number, wanted: number): number[] {
  const boxes = new Map<string, number[]>();
  const kept: number[] = [];
  for (let i = 0; 3 * i < x.length && kept.length <= wanted; ++i) {
    const p = [x[3 * i], x[3 * i + 1], x[3 * i + 2]];
    const b = p.map((c) => Math.floor(c / h));
    let free = true;
    for (let dx = -1; dx <= 1 && free; ++dx)
      for (let dy = -1; dy <= 1 && free; ++dy)
        for (let dz = -1; dz <= 1 && free; ++dz)
          for (const j of boxes.get(`${b[0] + dx},${b[1] + dy},${b[2] + dz}`) ?? [])
            if (Math.hypot(x[3 * j] - p[0], x[3 * j + 1] - p[1], x[3 * j + 2] - p[2]) < h * 0.999) free = false;
    if (!free) continue;
    kept.push(i);
    const key = b.join(',');
    const box = boxes.get(key);
    if (box) box.push(i);
    else boxes.set(key, [i]);
  }
  return kept;
}

/** Places of a hexagonal grid on a flat shape, about `wanted` of them, one in the middle of its extent; each in a triangle, by weights of its corners. */
export interface Samples {
  places: Float32Array;
  corners: Uint32Array;
  weights: Float32Array;
}

export function sampled(x: Float32Array, triangles: Uint32Array, wanted: number): Samples {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  let area = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    area += 0.5 * Math.abs((x[b] - x[a]) * (x[c + 1] - x[a + 1]) - (x[c] - x[a]) * (x[b + 1] - x[a + 1]));
    for (const v of [a, b, c]) for (const k of [0, 1]) (low[k] = Math.min(low[k], x[v + k])), (high[k] = Math.max(high[k], x[v + k]));
  }
  const h = Math.sqrt((2 * area) / (Math.sqrt(3) * Math.max(1, wanted))), rise = (Math.sqrt(3) / 2) * h;
  const middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
  const seen = new Set<string>();
  const places: number[] = [], corners: number[] = [], weights: number[] = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const v = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const px = v.map((i) => x[3 * i]), py = v.map((i) => x[3 * i + 1]);
    const twice = (px[1] - px[0]) * (py[2] - py[0]) - (px[2] - px[0]) * (py[1] - py[0]);
    if (twice === 0) continue;
    const firstRow = Math.ceil((Math.min(...py) - middle[1]) / rise - 1e-6), lastRow = Math.floor((Math.max(...py) - middle[1]) / rise + 1e-6);
    for (let row = firstRow; row <= lastRow; ++row) {
      const y = middle[1] + row * rise, shift = row % 2 === 0 ? 0 : 0.5;
      const first = Math.ceil((Math.min(...px) - middle[0]) / h - shift - 1e-6), last = Math.floor((Math.max(...px) - middle[0]) / h - shift + 1e-6);
      for (let k = first; k <= last; ++k) {
        const at = middle[0] + (k + shift) * h;
        const w = [0, 1, 2].map((i) => {
          const j = (i + 1) % 3, l = (i + 2) % 3;
          return ((px[j] - at) * (py[l] - y) - (px[l] - at) * (py[j] - y)) / twice;
        });
        if (Math.min(...w) < -1e-6 || seen.has(`${row},${k}`)) continue;
        seen.add(`${row},${k}`);
        places.push(at, y, w[0] * x[3 * v[0] + 2] + w[1] * x[3 * v[1] + 2] + w[2] * x[3 * v[2] + 2]);
        corners.push(...v);
        weights.push(...w);
      }
    }
  }
  return { places: new Float32Array(places), corners: new Uint32Array(corners), weights: new Float32Array(weights) };
}

/** Directions at the samples, from those at the vertices. */
export function directionsAt(samples: Samples, values: Float32Array): Float32Array {
  const out = new Float32Array(samples.places.length);
  for (let i = 0; i < out.length; i += 3) {
    for (let k = 0; k < 3; ++k) for (let c = 0; c < 3; ++c) out[i + k] += samples.weights[i + c] * values[3 * samples.corners[i + c] + k];
    const n = Math.hypot(out[i], out[i + 1], out[i + 2]);
    for (let k = 0; k < 3; ++k) out[i + k] /= n;
  }
  return out;
}
