// The legend under the picture, on any 2D canvas: a colour bar with ticks, or the disc of directions, or the keys of the glyphs.

import { colourMap, directionColour } from './colours';
import { anisotropyColour } from './glyphs';
import { FieldInfo, GlyphInfo } from './data';
import { powers, short, ticks } from './numbers';
import { ShownRange } from './stage';
import { colour } from './theme';

export interface LegendContent {
  field?: FieldInfo;
  range?: ShownRange;
  map: string;
  glyphs?: GlyphInfo;
  /** Arrows and rods are coloured by their direction. */
  tinted: boolean;
  hasNeutral: boolean;
}

const font = (size: number, weight = 400) => `${weight} ${size}px system-ui, "Segoe UI", "Helvetica Neue", Arial, sans-serif`;

export function legendHeight(content: LegendContent): number {
  return content.field?.kind === 'direction' ? 92 : content.field || content.glyphs ? 50 : 18;
}

/** Draws into the rectangle (x, y, width, legendHeight) in CSS pixels of the context. */
export function drawLegend(context: CanvasRenderingContext2D, x: number, y: number, width: number, content: LegendContent): void {
  const ink = colour('--ink'), soft = colour('--soft');
  context.textBaseline = 'alphabetic';
  let right = x + width;
  if (content.glyphs) right = drawGlyphKey(context, x + width, y, content.glyphs, content.tinted && content.field?.kind !== 'direction', ink, soft) - 24;
  if (!content.field) {
    if (!content.glyphs) {
      context.font = font(12);
      context.fillStyle = soft;
      context.fillText('Plain shape', x, y + 13);
    }
    return;
  }
  if (content.hasNeutral) {
    const text = 'no number';
    context.font = font(11.5);
    const w = context.measureText(text).width;
    context.fillStyle = '#acacac';
    context.fillRect(right - w - 18, y + 3, 12, 12);
    context.fillStyle = soft;
    context.fillText(text, right - w, y + 13);
  }
  context.font = font(12.5, 600);
  context.fillStyle = ink;
  context.fillText(content.field.label, x, y + 13);
  if (content.field.kind === 'direction') return drawDirections(context, x, y + 20, soft);
  if (!content.range) return;
  drawBar(context, x, y + 20, Math.min(520, right - x), content.range, content.map, soft);
}

function drawBar(context: CanvasRenderingContext2D, x: number, y: number, width: number, range: ShownRange, mapName: string, soft: string): void {
  const map = colourMap(mapName);
  const bar = context.createLinearGradient(x, 0, x + width, 0);
  for (let i = 0; i <= 32; ++i) bar.addColorStop(i / 32, map.at(i / 32));
  context.fillStyle = bar;
  context.beginPath();
  context.roundRect(x, y, width, 11, 2);
  context.fill();
  const { low, high, logarithmic } = range;
  context.font = font(11.5);
  context.fillStyle = soft;
  context.strokeStyle = soft;
  context.lineWidth = 1;
  const place = (v: number) => x + width * (logarithmic ? Math.log(v / low) / Math.log(high / low) : (v - low) / (high - low));
  const tens = logarithmic ? powers(low, high, 6) : [];
  const list = !(high > low) ? [low] : logarithmic && tens.length > 1 ? tens : logarithmic ? [low, high] : ticks(low, high, Math.max(2, Math.min(7, Math.floor(width / 70))));
  let last = -Infinity;
  for (const v of list) {
    const at = high > low ? place(v) : x;
    const near = Math.abs(v) < 1e-9 * (high - low) ? 0 : v;
    const text = (v === high && range.above ? '≥ ' : v === low && range.below ? '≤ ' : '') + short(near, 3);
    const w = context.measureText(text).width;
    const left = Math.min(Math.max(x, at - w / 2), x + width - w);
    if (left < last + 8) continue;
    last = left + w;
    context.fillRect(Math.round(Math.min(Math.max(at, x), x + width - 1)), y + 11, 1, 4);
    context.fillText(text, left, y + 27);
  }
  const notes = [range.below ? 'smaller values in the first colour' : '', range.above ? 'larger values in the last colour' : ''].filter(Boolean).join(', ');
  if (notes) {
    const w = context.measureText(notes).width;
    if (w < width * 0.6) context.fillText(notes, x + width - w, y - 7);
  }
}

/** The sphere of directions seen from +z, area-preserving: +z in the middle, -z on the rim. */
function drawDisc(context: CanvasRenderingContext2D, x: number, y: number, r: number): void {
  const disc = document.createElement('canvas');
  const fine = 4;
  disc.width = disc.height = 2 * r * fine;
  const inner = disc.getContext('2d')!;
  const pixels = inner.createImageData(disc.width, disc.height);
  for (let j = 0; j < disc.height; ++j) {
    for (let i = 0; i < disc.width; ++i) {
      const u = (i + 0.5) / (r * fine) - 1, v = 1 - (j + 0.5) / (r * fine);
      const s = u * u + v * v;
      if (s > 1) continue;
      const z = 1 - 2 * s, n = s > 0 ? Math.sqrt((1 - z * z) / s) : 0;
      pixels.data.set([...directionColour(u * n, v * n, z), 255], 4 * (j * disc.width + i));
    }
  }
  inner.putImageData(pixels, 0, 0);
  context.imageSmoothingEnabled = true;
  context.imageSmoothingQuality = 'high';
  context.drawImage(disc, x, y, 2 * r, 2 * r);
}

function drawDirections(context: CanvasRenderingContext2D, x: number, y: number, soft: string): void {
  const r = 32;
  drawDisc(context, x + 14, y + 2, r);
  context.font = font(11.5);
  context.fillStyle = soft;
  const text = ['hue: direction in the xy plane (+x right, +y up)', 'light in the middle: +z', 'dark on the rim: −z'];
  text.forEach((line, k) => context.fillText(line, x + 2 * r + 30, y + 22 + 17 * k));
}

/** Key of the glyphs, right aligned; returns where it begins. `directions`: what the colours of arrows mean is not told elsewhere. */
function drawGlyphKey(context: CanvasRenderingContext2D, right: number, y: number, glyphs: GlyphInfo, directions: boolean, ink: string, soft: string): number {
  context.font = font(12.5, 600);
  const words = `${{ arrow: 'arrows', rod: 'rods', frame: '', ellipsoid: 'ellipsoids' }[glyphs.kind]} ${glyphs.name}`.trim();
  let left = right - context.measureText(words).width;
  context.font = font(11.5);
  const keys: [string, string][] = glyphs.kind === 'frame' ? [['#e76f54', 'd₁'], ['#61bc83', 'd₂'], ['#5a8fe3', 'd₃']] : [];
  const total = keys.reduce((sum, [, text]) => sum + 14 + context.measureText(text).width + 10, -10);
  const disc = directions && (glyphs.kind === 'arrow' || glyphs.kind === 'rod');
  left = Math.min(left, right - (glyphs.kind === 'ellipsoid' ? anisotropyWidth(context) : disc ? context.measureText(discWords).width + 36 : total));
  context.font = font(12.5, 600);
  context.fillStyle = ink;
  context.fillText(words, left, y + 13);
  context.font = font(11.5);
  if (glyphs.kind === 'ellipsoid') drawAnisotropy(context, left, y, soft);
  if (disc) {
    drawDisc(context, left, y + 20, 14);
    context.fillStyle = soft;
    context.fillText(discWords, left + 36, y + 38);
  }
  let at = left;
  for (const [paint, text] of keys) {
    context.fillStyle = paint;
    context.fillRect(at, y + 23, 10, 10);
    context.fillStyle = soft;
    context.fillText(text, at + 14, y + 32);
    at += 14 + context.measureText(text).width + 10;
  }
  return left;
}

const discWords = 'seen from +z, −z on the rim';
const anisotropyWords = 'anisotropy: 0', anisotropyBar = 90;

function anisotropyWidth(context: CanvasRenderingContext2D): number {
  return context.measureText(anisotropyWords).width + anisotropyBar + context.measureText('1').width + 14;
}

function drawAnisotropy(context: CanvasRenderingContext2D, left: number, y: number, soft: string): void {
  const begin = left + context.measureText(anisotropyWords).width + 7;
  const bar = context.createLinearGradient(begin, 0, begin + anisotropyBar, 0);
  for (let i = 0; i <= 16; ++i) bar.addColorStop(i / 16, anisotropyColour(i / 16));
  context.fillStyle = soft;
  context.fillText(anisotropyWords, left, y + 32);
  context.fillText('1', begin + anisotropyBar + 7, y + 32);
  context.fillStyle = bar;
  context.beginPath();
  context.roundRect(begin, y + 22.5, anisotropyBar, 11, 2);
  context.fill();
}
