// Colour maps: numbers to colours (perceptual scales of d3-scale-chromatic) and directions to colours (hue by azimuth, lightness by height, in OKLCH).

import { interpolateCividis, interpolateInferno, interpolateMagma, interpolatePlasma, interpolatePuOr, interpolateRdBu, interpolateViridis, interpolateYlGnBu, interpolateYlOrRd } from 'd3-scale-chromatic';

export interface ColourMap {
  name: string;
  at: (x: number) => string;
  /** The middle stands for zero. */
  diverging: boolean;
}

export const colourMaps: ColourMap[] = [
  { name: 'viridis', at: interpolateViridis, diverging: false },
  { name: 'cividis', at: interpolateCividis, diverging: false },
  { name: 'plasma', at: interpolatePlasma, diverging: false },
  { name: 'inferno', at: interpolateInferno, diverging: false },
  { name: 'magma', at: interpolateMagma, diverging: false },
  { name: 'yellow-green-blue', at: interpolateYlGnBu, diverging: false },
  { name: 'yellow-orange-red', at: interpolateYlOrRd, diverging: false },
  { name: 'red-blue', at: (x) => interpolateRdBu(1 - x), diverging: true },
  { name: 'orange-purple', at: (x) => interpolatePuOr(1 - x), diverging: true },
];

export function colourMap(name: string): ColourMap {
  return colourMaps.find((m) => m.name === name) ?? colourMaps[0];
}

/** "#rrggbb" or "rgb(r, g, b)" to three numbers in 0..255. */
export function parseColour(text: string): [number, number, number] {
  if (text.startsWith('#')) return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16)) as [number, number, number];
  return (text.match(/[\d.]+/g) ?? ['0', '0', '0']).slice(0, 3).map(Number) as [number, number, number];
}

export function table(map: ColourMap, size = 256): Uint8Array {
  const out = new Uint8Array(4 * size);
  for (let i = 0; i < size; ++i) {
    const [r, g, b] = parseColour(map.at(i / (size - 1)));
    out.set([r, g, b, 255], 4 * i);
  }
  return out;
}

/** Björn Ottosson's OKLab to linear sRGB (https://bottosson.github.io/posts/oklab/), as GLSL; the same formula as `directionColour`. */
export const directionColourGlsl = /* glsl */ `
vec3 directionColour(vec3 n) {
  float h = atan(n.y, n.x), L = 0.68 + 0.22 * n.z, C = 0.145 * sqrt(max(0.0, 1.0 - n.z * n.z));
  float a = C * cos(h), b = C * sin(h);
  float l = L + 0.3963377774 * a + 0.2158037573 * b, m = L - 0.1055613458 * a - 0.0638541728 * b, s = L - 0.0894841775 * a - 1.2914855480 * b;
  l = l * l * l; m = m * m * m; s = s * s * s;
  return clamp(vec3(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s, -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                    -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 0.0, 1.0);
}`;

export function directionColour(x: number, y: number, z: number): [number, number, number] {
  const h = Math.atan2(y, x);
  const L = 0.68 + 0.22 * z;
  const C = 0.145 * Math.sqrt(Math.max(0, 1 - z * z));
  const a = C * Math.cos(h);
  const b = C * Math.sin(h);
  const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (L - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  return linear.map((v) => {
    const c = Math.min(1, Math.max(0, v));
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  }) as [number, number, number];
}
