// Synthetic results in the page's data format (src/data.ts), written independently of the C++ writer, for the browser tests.

import { deflateSync } from 'node:zlib';
import { readFileSync, writeFileSync } from 'node:fs';

const template = readFileSync(new URL('../dist/page.html', import.meta.url), 'utf8');

export class Arrays {
  infos = [];
  parts = [];
  size = 0;

  /** 16-bit numbers: `values` tuple after tuple. */
  u16(values, components = 1) {
    const count = values.length / components;
    const low = [], high = [], bytes = new Uint8Array(2 * values.length);
    for (let c = 0; c < components; ++c) {
      let a = Infinity, b = -Infinity;
      for (let i = c; i < values.length; i += components) if (Number.isFinite(values[i])) (a = Math.min(a, values[i])), (b = Math.max(b, values[i]));
      if (a > b) a = b = 0;
      low.push(a);
      high.push(b);
      let last = 0;
      for (let i = 0; i < count; ++i) {
        const v = values[i * components + c];
        const q = !Number.isFinite(v) ? 65535 : b > a ? Math.round(((v - a) / (b - a)) * 65534) : 0;
        const d = ((q - last) << 16) >> 16;
        const z = ((d << 1) ^ (d >> 31)) & 0xffff;
        last = q;
        bytes[2 * count * c + i] = z & 255;
        bytes[2 * count * c + count + i] = z >> 8;
      }
    }
    return this.add({ type: 'u16', count, components, low, high }, bytes);
  }

  words(type, values, components) {
    const count = values.length / components;
    const bytes = new Uint8Array(4 * values.length);
    for (let c = 0; c < components; ++c) {
      let last = 0;
      for (let i = 0; i < count; ++i) {
        let w = values[i * components + c];
        if (type === 'u32') {
          const d = (w - last) | 0;
          last = w;
          w = (d << 1) ^ (d >> 31);
        }
        for (let b = 0; b < 4; ++b) bytes[4 * count * c + b * count + i] = (w >>> (8 * b)) & 255;
      }
    }
    return this.add({ type, count, components }, bytes);
  }

  u32(values, components = 1) {
    return this.words('u32', Uint32Array.from(values), components);
  }

  f32(values, components = 1) {
    return this.words('f32', new Uint32Array(Float32Array.from(values).buffer), components);
  }

  add(info, bytes) {
    this.infos.push({ ...info, offset: this.size });
    this.parts.push(bytes);
    this.size += bytes.length;
    return this.infos.length - 1;
  }
}

export function packed(header, arrays) {
  const text = Buffer.from(JSON.stringify({ ...header, arrays: arrays.infos }));
  const size = Buffer.alloc(4);
  size.writeUInt32LE(text.length);
  return deflateSync(Buffer.concat([Buffer.from('KARCHER1'), size, text, ...arrays.parts])).toString('base64');
}

const escape = (s) => s.replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;').replace(/"/g, '&quot;');

export function page(header, arrays) {
  return template.replace('@KARCHER_TITLE@', () => escape(header.title)).replace('@KARCHER_DATA@', () => packed(header, arrays));
}

/** Steps and iterations of a plausible run. */
export function course(states, rejectedAt = 3) {
  const steps = [];
  const it = { load_step: [], iteration: [], energy: [], gradient_norm: [], step_norm: [], accepted: [] };
  for (let s = 1; s <= states; ++s) {
    const t = s / states;
    for (let i = 1; i <= 6; ++i) {
      it.load_step.push(s);
      it.iteration.push(i);
      it.energy.push(t * t * (1 + 2 ** -i));
      it.gradient_norm.push(10 ** (1 - 1.6 * i));
      it.step_norm.push(10 ** (0.3 - 0.9 * i));
      it.accepted.push(i === rejectedAt ? 0 : 1);
    }
    steps.push({
      step: s, t, status: 'converged', reason: 'The gradient norm 3.1e-9 is at most 1e-8 times the largest one seen (0.63); no negative eigenvalues: a strict local minimum.',
      iterations: 6, energy: t * t, energies: { 'cosserat-shell': 2 * t * t, 'volume-load': -t * t }, probes: { tip: [0.1 * t, -0.2 * t * t, 0.4 * t] },
      gradient_norm: 3.1e-9, negative_eigenvalues: s === 2 ? 1 : 0, factorisations: 5, seconds: 0.8,
    });
  }
  return { steps, iterations: it };
}

export function base(title, states) {
  return {
    format: 1, title, version: '0.1.0', machine: '8 cores, Linux', status: 'converged',
    result: 'All 4 load steps converged; the Hessian at the end has no negative eigenvalue, so this is a strict local minimum.',
    notes: [], problem: 'title = "test"\n\n[mesh]\ngenerate = "moebius"\n',
    facts: [['cells', '256 quadrilaterals of order 2'], ['nodes', '1088'], ['unknowns', '6528'], ['ranks', '1'], ['peak memory', '210 MB']],
    seconds: { total: 3.1, assembly: 0.4, factorisation: 1.9, solve: 0.3, output: 0.2, setup: 0.25 }, ...course(states),
  };
}

/** A grid of nu x nv cells, each cut `cut` times in both directions; closed in u where wrap(v) tells which v meets v after one turn. */
function grid(nu, nv, cut, place, wrap) {
  const mu = nu * cut, mv = nv * cut;
  const rows = wrap ? mu : mu + 1;
  const reference = [];
  const parameters = [];
  for (let i = 0; i < rows; ++i) {
    for (let j = 0; j <= mv; ++j) {
      reference.push(...place(i / mu, j / mv, 0));
      parameters.push([i / mu, j / mv]);
    }
  }
  const at = (i, j) => (wrap && i === mu ? wrap(j, mv) : i * (mv + 1) + j);
  const triangles = [], cells = [], edges = [], lengths = [], strong = [], strongLengths = [];
  for (let a = 0; a < nu; ++a) {
    for (let b = 0; b < nv; ++b) {
      for (let p = 0; p < cut; ++p) {
        for (let q = 0; q < cut; ++q) {
          const i = a * cut + p, j = b * cut + q;
          triangles.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1));
          cells.push(a * nv + b, a * nv + b);
        }
      }
      const along = (f) => Array.from({ length: cut + 1 }, (_, k) => f(k));
      for (const [list, border] of [
        [along((k) => at(a * cut + k, b * cut)), b === 0],
        [along((k) => at(a * cut, b * cut + k)), a === 0 && !wrap],
        ...(b === nv - 1 ? [[along((k) => at(a * cut + k, mv)), true]] : []),
        ...(a === nu - 1 && !wrap ? [[along((k) => at(mu, b * cut + k)), true]] : []),
      ]) {
        (border ? strong : edges).push(...list);
        (border ? strongLengths : lengths).push(cut + 1);
      }
    }
  }
  return { reference, parameters, triangles, cells, cellCount: nu * nv, edges: [...strong, ...edges], lengths: [...strongLengths, ...lengths], strong: strongLengths.length };
}

function shapeOf(arrays, g, states, flat) {
  return {
    vertices: g.reference.length / 3, cells: g.cellCount, flat, reference: arrays.f32(g.reference, 3), states, displacement: [],
    triangles: arrays.u32(g.triangles, 3), triangle_cells: arrays.u32(g.cells), edges: arrays.u32(g.edges), edge_lengths: arrays.u32(g.lengths), strong_edges: g.strong,
    fields: [], glyphs: [], start: { field: '', glyphs: '' },
  };
}

const stateList = (n) => Array.from({ length: n + 1 }, (_, s) => ({ step: s, t: s / n }));

/** Places minus reference, by state. */
function displacements(arrays, g, place, states) {
  return states.map(({ t }) => arrays.u16(g.parameters.flatMap(([u, v], i) => place(u, v, t).map((x, k) => x - g.reference[3 * i + k])), 3));
}

export function moebius({ title = 'Moebius strip under its own weight', nu = 64, nv = 4, cut = 4, steps = 4, nan = false, peak = false } = {}) {
  const arrays = new Arrays();
  const place = (u, v, t) => {
    const a = 2 * Math.PI * u, w = (v - 0.5) * 1.1, r = 1.5 + w * Math.cos(a / 2);
    const sag = t * 0.9 * Math.cos(a / 2) ** 2 * (1 + 0.3 * w * Math.cos(a / 2));
    return [r * Math.cos(a), r * Math.sin(a), w * Math.sin(a / 2) - sag];
  };
  const g = grid(nu, nv, cut, place, (j, mv) => mv - j);
  const states = stateList(steps);
  const shape = shapeOf(arrays, g, states, false);
  shape.displacement = displacements(arrays, g, place, states);
  const density = (scale, power) =>
    states.map(({ t }) => arrays.u16(Array.from({ length: g.cellCount }, (_, c) => {
      const u = Math.floor(c / nv) / nu;
      return nan && c % 17 === 3 ? NaN : (peak && c === 5 ? 200 : 1) * scale * t * t * (0.05 + Math.abs(Math.sin(2 * Math.PI * u)) ** power);
    })));
  const cells = (name, label, arraysOf, missing = 0) => ({ name, label, kind: 'scalar', at: 'cell', arrays: arraysOf, not_finite: missing });
  shape.fields.push(cells('energy', 'energy density', density(3, 2), nan ? Math.ceil((g.cellCount - 3) / 17) * (steps + 1) : 0), cells('membrane', 'membrane part', density(2, 4)), cells('bending', 'bending part', density(1, 1)));
  shape.fields.push({ name: 'displacement', label: 'displacement', kind: 'scalar', at: 'vertex', not_finite: 0, arrays: states.map(({ t }) => arrays.u16(g.parameters.map(([u, v], i) => Math.hypot(...place(u, v, t).map((x, k) => x - g.reference[3 * i + k]))))) });
  const nodes = g.parameters.map((_, i) => i).filter((i) => i % 3 === 0);
  shape.glyphs.push({
    name: 'directors of Q', kind: 'frame', reference: arrays.f32(nodes.flatMap((i) => g.reference.slice(3 * i, 3 * i + 3)), 3),
    displacement: states.map(({ t }) => arrays.u16(nodes.flatMap((i) => place(...g.parameters[i], t).map((x, k) => x - g.reference[3 * i + k])), 3)),
    arrays: states.map(({ t }) => arrays.u16(nodes.flatMap((i) => { const a = Math.PI * g.parameters[i][0] + 0.4 * t; return [0, 0, Math.sin(a), Math.cos(a)]; }), 4)),
  });
  shape.start.field = 'energy';
  return page({ ...base(title, steps), shape }, arrays);
}

/** The boundary of a bent and twisted bar. */
export function solid() {
  const arrays = new Arrays();
  const bend = (x, y, z, t) => {
    const a = 0.9 * t * x / 4, k = 1.2 * t / 4;
    const c = Math.cos(a), s = Math.sin(a);
    const [y1, z1] = [c * y - s * z, s * y + c * z];
    const b = k * x, r = k > 0 ? 1 / k : 0;
    return k > 0 ? [(r - z1) * Math.sin(b), y1, r - (r - z1) * Math.cos(b)] : [x, y1, z1];
  };
  const sides = [
    (u, v) => [4 * u, v - 0.5, 0.5], (u, v) => [4 * u, v - 0.5, -0.5], (u, v) => [4 * u, 0.5, v - 0.5], (u, v) => [4 * u, -0.5, v - 0.5],
    (u, v) => [0, u - 0.5, v - 0.5], (u, v) => [4, u - 0.5, v - 0.5],
  ];
  const all = { reference: [], parameters: [], triangles: [], cells: [], cellCount: 0, edges: [], lengths: [], strong: 0 };
  const strong = [], strongLengths = [];
  for (const side of sides) {
    const g = grid(side === sides[4] || side === sides[5] ? 4 : 16, 4, 3, (u, v) => side(u, v));
    const offset = all.reference.length / 3;
    all.reference.push(...g.reference);
    all.triangles.push(...g.triangles.map((v) => v + offset));
    all.cells.push(...g.cells.map((c) => c + all.cellCount));
    all.cellCount += g.cellCount;
    let at = 0;
    g.lengths.forEach((n, k) => {
      (k < g.strong ? strong : all.edges).push(...g.edges.slice(at, at + n).map((v) => v + offset));
      (k < g.strong ? strongLengths : all.lengths).push(n);
      at += n;
    });
  }
  all.strong = strongLengths.length;
  all.edges = [...strong, ...all.edges];
  all.lengths = [...strongLengths, ...all.lengths];
  const states = stateList(4);
  const shape = shapeOf(arrays, all, states, false);
  const x = [];
  for (let i = 0; i < all.reference.length; i += 3) x.push(all.reference.slice(i, i + 3));
  shape.displacement = states.map(({ t }) => arrays.u16(x.flatMap((p) => bend(...p, t).map((c, k) => c - p[k])), 3));
  shape.fields.push({ name: 'displacement', label: 'displacement', kind: 'scalar', at: 'vertex', not_finite: 0, arrays: states.map(({ t }) => arrays.u16(x.map((p) => Math.hypot(...bend(...p, t).map((c, k) => c - p[k]))))) });
  shape.start.field = 'displacement';
  return page({ ...base('A bar, bent and twisted', 4), shape }, arrays);
}

/** A helix with directors. */
export function curve() {
  const arrays = new Arrays();
  const cells = 40, cut = 4, n = cells * cut;
  const place = (u, t) => { const a = 6 * Math.PI * u * (1 - 0.4 * t), r = 1 + 0.3 * t; return [r * Math.cos(a), r * Math.sin(a), 3 * u * (1 + 0.3 * t)]; };
  const u = Array.from({ length: n + 1 }, (_, i) => i / n);
  const states = stateList(5);
  const reference = u.flatMap((s) => place(s, 0));
  const shift = (list) => states.map(({ t }) => arrays.u16(list.flatMap((s) => place(s, t).map((x, k) => x - place(s, 0)[k])), 3));
  const nodes = u.filter((_, i) => i % cut === 0);
  const shape = {
    vertices: n + 1, cells, flat: false, reference: arrays.f32(reference, 3), states, displacement: shift(u),
    curves: arrays.u32(Array.from({ length: cells }, (_, c) => Array.from({ length: cut + 1 }, (_, k) => c * cut + k)).flat()), curve_lengths: arrays.u32(Array(cells).fill(cut + 1)),
    curve_cells: arrays.u32(Array.from({ length: cells }, (_, c) => c)), strong_edges: 0,
    fields: [{ name: 'energy', label: 'energy density', kind: 'scalar', at: 'cell', not_finite: 0, arrays: states.map(({ t }) => arrays.u16(Array.from({ length: cells }, (_, c) => t * (1 + Math.sin(c / 5))))) }],
    glyphs: [{ name: 'directors of Q', kind: 'frame', reference: arrays.f32(nodes.flatMap((s) => place(s, 0)), 3), displacement: shift(nodes), arrays: states.map(({ t }) => arrays.u16(nodes.flatMap((s) => { const a = 3 * Math.PI * s * (1 - 0.4 * t); return [0, 0, Math.sin(a), Math.cos(a)]; }), 4)) }],
    start: { field: 'energy', glyphs: 'directors of Q' },
  };
  return page({ ...base('A spring, pulled', 5), shape }, arrays);
}

/** A skyrmion: a map of the plane into S^2. */
export function sphereMap() {
  const arrays = new Arrays();
  const place = (u, v) => [6 * u - 3, 6 * v - 3, 0];
  const g = grid(24, 24, 2, place);
  const states = [{ step: 0, t: 0 }, { step: 1, t: 1 }];
  const shape = shapeOf(arrays, g, states, true);
  const m = (u, v, t) => {
    const [x, y] = place(u, v), r = Math.hypot(x, y) + 1e-9, angle = Math.PI * Math.exp(-((r / (1 + t)) ** 2));
    return [(-Math.sin(angle) * y) / r, (Math.sin(angle) * x) / r, Math.cos(angle)];
  };
  shape.fields.push({ name: 'm', label: 'm, as a direction', kind: 'direction', at: 'vertex', not_finite: 0, arrays: states.map(({ t }) => arrays.u16(g.parameters.flatMap(([u, v]) => m(u, v, t)), 3)) });
  shape.fields.push({ name: 'energy', label: 'energy density', kind: 'scalar', at: 'cell', not_finite: 0, arrays: states.map(({ t }) => arrays.u16(Array.from({ length: 576 }, (_, c) => { const [x, y] = place((Math.floor(c / 24) + 0.5) / 24, ((c % 24) + 0.5) / 24); return (4 + t) * Math.exp(-x * x - y * y) - 0.5 * t; }))) });
  shape.glyphs.push({ name: 'm', kind: 'arrow', reference: arrays.f32(g.reference, 3), displacement: [], arrays: states.map(({ t }) => arrays.u16(g.parameters.flatMap(([u, v]) => m(u, v, t)), 3)) });
  shape.start = { field: 'm', glyphs: 'm' };
  return page({ ...base('A skyrmion', 1), shape }, arrays);
}

/** Symmetric positive matrices on the plane. */
export function spd() {
  const arrays = new Arrays();
  const place = (u, v) => [2 * u - 1, 2 * v - 1, 0];
  const g = grid(12, 12, 1, place);
  const states = [{ step: 1, t: 1 }];
  const shape = shapeOf(arrays, g, states, true);
  const p = ([u, v]) => { const a = 2 * u + v, e = [Math.exp(1.2 * u), Math.exp(-v), 0.5], c = Math.cos(a), s = Math.sin(a); return [c * c * e[0] + s * s * e[1], s * s * e[0] + c * c * e[1], e[2], c * s * (e[0] - e[1]), 0, 0]; };
  shape.fields.push({ name: 'energy', label: 'energy density', kind: 'scalar', at: 'cell', not_finite: 0, arrays: [arrays.u16(Array.from({ length: 144 }, (_, c) => 1 + (c % 12) + Math.floor(c / 12) ** 1.3))] });
  shape.glyphs.push({ name: 'P', kind: 'ellipsoid', reference: arrays.f32(g.reference, 3), displacement: [], arrays: [arrays.u16(g.parameters.flatMap(p), 6)] });
  shape.start = { field: '', glyphs: 'P' };
  return page({ ...base('Diffusion tensors', 1), shape }, arrays);
}

/** A run that failed before any state was stored. */
export function failed() {
  const header = { ...base('A run that failed', 2), status: 'failed', result: 'The first load step failed: the energy is infinite at the initial configuration.', steps: [], shape: undefined };
  header.iterations = { load_step: [], iteration: [], energy: [], gradient_norm: [], step_norm: [], accepted: [] };
  return page(header, new Arrays());
}

export const pages = { moebius, solid, curve, sphereMap, spd, failed, nasty: () => moebius({ title: 'A "quoted" title </script><b>&amp; \'more\'', nan: true }), peak: () => moebius({ title: 'A peak', peak: true }), large: () => moebius({ nu: 208, nv: 12, cut: 2, steps: 9 }) };

if (process.argv[1] === new URL(import.meta.url).pathname) {
  for (const [name, make] of Object.entries(pages)) writeFileSync(`${process.argv[2]}/${name}.html`, make());
}
