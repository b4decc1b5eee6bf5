// Pixels of PNG files: enough of a reader for what Chromium writes (8 bits, RGB or RGBA, not interlaced).

import { inflateSync } from 'node:zlib';

export function readPng(bytes) {
  let at = 8, width = 0, height = 0, channels = 4;
  const data = [];
  while (at < bytes.length) {
    const length = bytes.readUInt32BE(at), type = bytes.toString('latin1', at + 4, at + 8), body = bytes.subarray(at + 8, at + 8 + length);
    if (type === 'IHDR') {
      width = body.readUInt32BE(0);
      height = body.readUInt32BE(4);
      if (body[8] !== 8 || ![2, 6].includes(body[9]) || body[12] !== 0) throw new Error('a PNG of another kind');
      channels = body[9] === 6 ? 4 : 3;
    }
    if (type === 'IDAT') data.push(body);
    at += 12 + length;
  }
  const raw = inflateSync(Buffer.concat(data)), stride = width * channels, pixels = new Uint8Array(stride * height);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    for (let x = 0; x < stride; ++x) {
      const left = x >= channels ? pixels[y * stride + x - channels] : 0, up = y > 0 ? pixels[(y - 1) * stride + x] : 0;
      const corner = x >= channels && y > 0 ? pixels[(y - 1) * stride + x - channels] : 0;
      let guess = 0;
      if (filter === 1) guess = left;
      if (filter === 2) guess = up;
      if (filter === 3) guess = (left + up) >> 1;
      if (filter === 4) {
        const p = left + up - corner, a = Math.abs(p - left), b = Math.abs(p - up), c = Math.abs(p - corner);
        guess = a <= b && a <= c ? left : b <= c ? up : corner;
      }
      pixels[y * stride + x] = raw[y * (stride + 1) + 1 + x] + guess;
    }
  }
  const pixel = (x, y) => Array.from(pixels.subarray(y * stride + x * channels, y * stride + x * channels + 3));
  return { width, height, pixel };
}

/** Part of the pixels for which `test(red, green, blue)` holds. */
export function part(png, test) {
  let count = 0;
  for (let y = 0; y < png.height; ++y) for (let x = 0; x < png.width; ++x) if (test(...png.pixel(x, y))) ++count;
  return count / (png.width * png.height);
}

/** Part of the pixels that differ plainly between two pictures of one size. */
export function difference(a, b) {
  if (a.width !== b.width || a.height !== b.height) return 1;
  let count = 0;
  for (let y = 0; y < a.height; ++y) {
    for (let x = 0; x < a.width; ++x) {
      const p = a.pixel(x, y), q = b.pixel(x, y);
      if (Math.abs(p[0] - q[0]) + Math.abs(p[1] - q[1]) + Math.abs(p[2] - q[2]) > 24) ++count;
    }
  }
  return count / (a.width * a.height);
}

/** Part of the pixels that are not like the one at (`corner`, `corner`): what is drawn on the ground. */
export function drawn(png, corner = 2) {
  const ground = png.pixel(corner, corner);
  return part(png, (r, g, b) => Math.abs(r - ground[0]) + Math.abs(g - ground[1]) + Math.abs(b - ground[2]) > 24);
}
