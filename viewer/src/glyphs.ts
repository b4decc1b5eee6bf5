// Arrows, rods, director triads and ellipsoids as instances of one small mesh each.

import { BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, InstancedBufferAttribute, InstancedBufferGeometry, SphereGeometry } from 'three';
import { interpolatePlasma } from 'd3-scale-chromatic';
import { directionColour, parseColour } from './colours';
import { GlyphInfo } from './data';
import { eigenvectors } from './eigen';

type Rgb = [number, number, number];

/** Colours of the three directors (linear), readable on light and dark ground and for the colour-blind. */
export const directorColours: Rgb[] = [
  [0.80, 0.16, 0.09],
  [0.12, 0.50, 0.22],
  [0.10, 0.28, 0.78],
];

const white: Rgb = [1, 1, 1];

/** Merges parts into one geometry with a colour per vertex. */
function merge(parts: { geometry: BufferGeometry; colour: Rgb }[]): BufferGeometry {
  const position: number[] = [], normal: number[] = [], paint: number[] = [];
  for (const { geometry, colour } of parts) {
    const g = geometry.toNonIndexed();
    position.push(...g.getAttribute('position').array);
    normal.push(...g.getAttribute('normal').array);
    for (let i = 0; i < g.getAttribute('position').count; ++i) paint.push(...colour);
  }
  const out = new BufferGeometry();
  out.setAttribute('position', new BufferAttribute(new Float32Array(position), 3));
  out.setAttribute('normal', new BufferAttribute(new Float32Array(normal), 3));
  out.setAttribute('paint', new BufferAttribute(new Float32Array(paint), 3));
  return out;
}

/** An arrow of length 1 along z with its middle (or its tail) at the origin. */
function arrow(radius: number, colour: Rgb, fromTail: boolean, sides: number): { geometry: BufferGeometry; colour: Rgb }[] {
  const head = 0.4;
  const base = fromTail ? 0 : -0.5;
  const shaft = new CylinderGeometry(radius, radius, 1 - head, sides).rotateX(Math.PI / 2).translate(0, 0, base + 0.5 * (1 - head));
  const cone = new ConeGeometry(2.3 * radius, head, sides).rotateX(Math.PI / 2).translate(0, 0, base + 1 - 0.5 * head);
  return [
    { geometry: shaft, colour },
    { geometry: cone, colour },
  ];
}

function template(kind: GlyphInfo['kind'], sides: number): BufferGeometry {
  if (kind === 'arrow') return merge(arrow(0.09, white, false, sides));
  if (kind === 'rod') return merge([{ geometry: new CylinderGeometry(0.09, 0.09, 1, sides).rotateX(Math.PI / 2), colour: white }]);
  if (kind === 'ellipsoid') return merge([{ geometry: new SphereGeometry(0.5, 2 * sides, sides), colour: white }]);
  const parts = [0, 1, 2].flatMap((k) =>
    arrow(0.055, directorColours[k], true, sides).map(({ geometry, colour }) => {
      if (k === 0) geometry.rotateY(Math.PI / 2);
      if (k === 1) geometry.rotateX(-Math.PI / 2);
      return { geometry, colour };
    }),
  );
  return merge(parts);
}

/** The rotation of a unit quaternion (x, y, z, w), column after column. */
export function quaternionAxes(x: number, y: number, z: number, w: number): number[] {
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),
    2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),
    2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y),
  ];
}

/** Columns whose third is v and whose first two are perpendicular to it and as thick as `thickness`. */
function along(v: number[], thickness: number): number[] {
  const n = Math.hypot(v[0], v[1], v[2]);
  const d = v.map((c) => c / n);
  const helper = Math.abs(d[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
  let a = [helper[1] * d[2] - helper[2] * d[1], helper[2] * d[0] - helper[0] * d[2], helper[0] * d[1] - helper[1] * d[0]];
  const m = Math.hypot(a[0], a[1], a[2]);
  a = a.map((c) => c / m);
  const b = [d[1] * a[2] - d[2] * a[1], d[2] * a[0] - d[0] * a[2], d[0] * a[1] - d[1] * a[0]];
  return [...a.map((c) => thickness * c), ...b.map((c) => thickness * c), ...v];
}

const componentsOf = { arrow: 3, rod: 3, frame: 4, ellipsoid: 6 };

/** The largest length among the values of a set: glyph sizes are relative to it. */
export function largestGlyph(kind: GlyphInfo['kind'], values: Float32Array): number {
  if (kind === 'frame') return 1;
  let largest = 0;
  const n = componentsOf[kind];
  for (let i = 0; i < values.length; i += n) {
    const size = kind === 'ellipsoid' ? 2 * Math.sqrt(Math.max(0, values[i], values[i + 1], values[i + 2])) : Math.hypot(values[i], values[i + 1], values[i + 2]);
    if (size > largest && Number.isFinite(size)) largest = size;
  }
  return largest || 1;
}

/** Glyphs at the points `chosen`. `size`: length of the glyph of a value of size 1. Values that are not finite are left out. */
export function glyphGeometry(kind: GlyphInfo['kind'], x: Float32Array, values: Float32Array, chosen: Uint32Array, size: number, tinted: boolean, plain: Rgb): InstancedBufferGeometry {
  const place: number[] = [], axes: number[][] = [[], [], []], tint: number[] = [];
  const n = componentsOf[kind];
  for (const i of chosen) {
    const v = Array.from(values.subarray(n * i, n * i + n));
    if (!v.every(Number.isFinite)) continue;
    let columns: number[];
    let colour: Rgb = white;
    if (kind === 'frame') columns = quaternionAxes(v[0], v[1], v[2], v[3]).map((c) => size * c);
    else if (kind === 'ellipsoid') {
      const { vectors, values: e } = eigenvectors(v);
      columns = vectors.flatMap((axis, k) => axis.map((c) => 2 * size * Math.sqrt(Math.max(e[k], 1e-6 * Math.max(...e, 1e-300))) * c));
      colour = parseColour(anisotropyColour(anisotropy(e))).map(linear) as Rgb;
    } else {
      const length = Math.hypot(v[0], v[1], v[2]);
      if (length === 0) continue;
      columns = along(v.map((c) => size * c), size * length);
      colour = tinted ? (directionColour(v[0] / length, v[1] / length, v[2] / length).map(linear) as Rgb) : plain;
    }
    place.push(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    for (let k = 0; k < 3; ++k) axes[k].push(...columns.slice(3 * k, 3 * k + 3));
    tint.push(...colour);
  }
  const count = place.length / 3;
  const mesh = template(kind, count > 1500 ? 8 : 14);
  const out = new InstancedBufferGeometry();
  for (const name of ['position', 'normal', 'paint']) out.setAttribute(name, mesh.getAttribute(name));
  out.setAttribute('place', new InstancedBufferAttribute(new Float32Array(place), 3));
  axes.forEach((a, k) => out.setAttribute(`axis${k}`, new InstancedBufferAttribute(new Float32Array(a), 3)));
  out.setAttribute('tint', new InstancedBufferAttribute(new Float32Array(tint), 3));
  out.instanceCount = count;
  return out;
}

function linear(byte: number): number {
  const c = byte / 255;
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
}

/** Fractional anisotropy of a symmetric positive matrix with these eigenvalues: 0 for a ball, 1 for the thinnest needle (Basser and Pierpaoli 1996). */
function anisotropy(e: number[]): number {
  const mean = (e[0] + e[1] + e[2]) / 3;
  const spread = Math.hypot(e[0] - mean, e[1] - mean, e[2] - mean);
  return Math.min(1, Math.sqrt(1.5) * (spread / (Math.hypot(e[0], e[1], e[2]) || 1)));
}

/** Colour of a fractional anisotropy, as CSS has it. The ends of plasma are too dark and too light for a ground of either kind. */
export function anisotropyColour(a: number): string {
  return interpolatePlasma(0.15 + 0.7 * a);
}
