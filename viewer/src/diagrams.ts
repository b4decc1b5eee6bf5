// The diagrams beside the picture: energy and probes by load step, the course of the iterations, negative eigenvalues, time by phase.

import uPlot from 'uplot';
import { Header } from './data';
import { duration, powers, short } from './numbers';
import { colour } from './theme';

interface Series {
  label: string;
  values: (number | null)[];
  paint: string;
  /** line: joined points; dots: points only; rings: open points only; stems: points on bars, for counts */
  style?: 'line' | 'dots' | 'rings' | 'stems';
}

interface Diagram {
  id: string;
  title: string;
  remark?: string;
  x: number[];
  xLabel: string;
  /** None: the remark says it all. */
  series: Series[];
  logarithmic?: boolean;
  /** x is a load step: a line marks the step shown, a click shows another. */
  steps?: boolean;
  /** Places of thin vertical lines. */
  cuts?: number[];
  height?: number;
}

const paints = ['--s1', '--s2', '--s3', '--s4', '--s5', '--s6'];

export class Diagrams {
  private readonly plots: { plot: uPlot; host: HTMLElement; steps: boolean }[] = [];
  private shown = 0;

  constructor(private readonly root: HTMLElement, private readonly header: Header, private readonly choose: (step: number) => void) {
    new ResizeObserver(() => this.resize()).observe(root);
  }

  /** Draws everything anew (at the start, and when the colours of the page have changed). */
  build(): void {
    for (const { plot } of this.plots.splice(0)) plot.destroy();
    this.root.replaceChildren();
    for (const d of diagramsOf(this.header)) this.add(d);
    this.addPhases();
  }

  /** Marks the load step of the picture. */
  mark(step: number): void {
    this.shown = step;
    for (const { plot, steps } of this.plots) if (steps) plot.redraw(false);
  }

  private resize(): void {
    for (const { plot, host } of this.plots) {
      const width = host.clientWidth;
      if (width > 0 && width !== plot.width) plot.setSize({ width, height: plot.height });
    }
  }

  private block(id: string, title: string, remark?: string): HTMLElement {
    const block = document.createElement('div');
    block.className = 'diagram';
    block.id = `diagram-${id}`;
    const heading = document.createElement('h2');
    heading.textContent = title;
    if (remark) {
      const small = document.createElement('small');
      small.textContent = ` ${remark}`;
      heading.append(small);
    }
    block.append(heading);
    this.root.append(block);
    return block;
  }

  private add(d: Diagram): void {
    const block = this.block(d.id, d.title, d.remark);
    if (d.series.length === 0) return;
    const host = document.createElement('div');
    host.className = 'plot';
    block.append(host);
    const counts = d.series.some((s) => s.style === 'stems');
    const soft = colour('--soft'), line = colour('--line');
    const font = '11px system-ui, "Segoe UI", Arial, sans-serif';
    const data = [d.x, ...d.series.map((s) => s.values.map((v) => (v === null || !Number.isFinite(v) || (d.logarithmic && v <= 0) ? null : v)))] as uPlot.AlignedData;
    const options: uPlot.Options = {
      width: Math.max(200, host.clientWidth || 300),
      height: d.height ?? 170,
      legend: { show: false },
      cursor: { y: false, drag: { x: false, y: false }, points: { size: 6 } },
      padding: [8, 8, 0, 0],
      scales: {
        x: { time: false, range: d.steps ? stepRange(d.x) : (_, low, high) => (high > low ? [low, high] : [low - 1, high + 1]) },
        y: d.logarithmic ? { distr: 3, log: 10 } : { range: counts ? (_, __, high) => [-0.12 * Math.max(1, high), Math.max(1, high) * 1.2] : comfortable },
      },
      axes: [
        {
          stroke: soft, font, labelFont: font, label: d.xLabel, labelSize: 16, size: 26, gap: 3, space: 44,
          grid: { show: false }, ticks: { stroke: line, width: 1, size: 4 },
          incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000],
        },
        {
          stroke: soft, font, size: 58, gap: 4, space: d.logarithmic ? 26 : 30, grid: { stroke: line, width: 1 }, ticks: { show: false },
          values: (_, splits) => splits.map((v) => (v === null ? '' : tick(v))),
          ...(d.logarithmic ? { splits: (_: uPlot, __: number, low: number, high: number) => powers(low, high, 5) } : {}),
          ...(counts ? { incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000] } : {}),
        },
      ],
      series: [{}, ...d.series.map((s) => seriesOptions(s, d.x.length))],
      hooks: {
        drawAxes: [(u) => (d.cuts ?? []).forEach((x) => vertical(u, x, line, 1))],
        draw: [(u) => d.steps && vertical(u, this.shown, colour('--accent'), 1.5)],
      },
    };
    const plot = new uPlot(options, data, host);
    const readout = key(d.series);
    block.append(readout);
    plot.over.addEventListener('click', () => {
      if (d.steps && plot.cursor.idx !== null && plot.cursor.idx !== undefined) this.choose(d.x[plot.cursor.idx]);
    });
    plot.over.addEventListener('mousemove', () => tell(readout, d, plot.cursor.idx));
    plot.over.addEventListener('mouseleave', () => tell(readout, d, null));
    this.plots.push({ plot, host, steps: d.steps === true });
  }

  private addPhases(): void {
    const { total, ...phases } = this.header.seconds;
    const known = Object.entries(phases).filter((e): e is [string, number] => e[1] !== null && e[1] > 0);
    if (known.length === 0 && !total) return;
    const sum = known.reduce((s, [, v]) => s + v, 0);
    const all = Math.max(total ?? sum, sum);
    known.sort((a, b) => b[1] - a[1]);
    if (all - sum > 0.005 * all) known.push(['other', all - sum]);
    const block = this.block('phases', 'Time by phase', `${duration(all)} in all`);
    const bar = document.createElement('div');
    bar.className = 'phases';
    const list = document.createElement('div');
    list.className = 'key';
    known.forEach(([name, seconds], k) => {
      const paint = name === 'other' ? colour('--soft') : colour(paints[k % paints.length]);
      const part = document.createElement('b');
      part.style.width = `${(100 * seconds) / all}%`;
      part.style.background = paint;
      part.title = `${name}: ${duration(seconds)}`;
      bar.append(part);
      list.append(keyEntry(`${name} ${duration(seconds)} (${((100 * seconds) / all).toFixed(0)} %)`, paint, 'dot'));
    });
    block.append(bar, list);
  }
}

function seriesOptions(s: Series, count: number): uPlot.Series {
  const none = () => null;
  if (s.style === 'stems') return { label: s.label, fill: s.paint, stroke: s.paint, width: 0, paths: uPlot.paths.bars!({ size: [0.1, 4] }), points: { show: true, size: 7, fill: s.paint, width: 0 } };
  if (s.style === 'dots') return { label: s.label, stroke: s.paint, paths: none, points: { show: true, size: 5, fill: s.paint, width: 0 } };
  if (s.style === 'rings') return { label: s.label, stroke: s.paint, paths: none, points: { show: true, size: 7, fill: 'transparent', width: 1.5 } };
  return { label: s.label, stroke: s.paint, width: 1.6, spanGaps: true, points: { show: count < 30, size: 5, fill: s.paint, width: 0 } };
}

/** Numbers of an axis; powers of ten where they are large or small. */
function tick(v: number): string {
  return short(Number(v.toPrecision(6)), 6);
}

function vertical(u: uPlot, x: number, paint: string, width: number): void {
  const at = Math.round(u.valToPos(x, 'x', true));
  if (!Number.isFinite(at) || at < u.bbox.left - 1 || at > u.bbox.left + u.bbox.width + 1) return;
  u.ctx.save();
  u.ctx.strokeStyle = paint;
  u.ctx.lineWidth = width * devicePixelRatio;
  u.ctx.beginPath();
  u.ctx.moveTo(at, u.bbox.top);
  u.ctx.lineTo(at, u.bbox.top + u.bbox.height);
  u.ctx.stroke();
  u.ctx.restore();
}

function stepRange(x: number[]): uPlot.Range.MinMax {
  const low = Math.min(...x), high = Math.max(...x);
  const pad = Math.max(0.5, 0.04 * (high - low));
  return [low - pad, high + pad];
}

function comfortable(_: uPlot, low: number | null, high: number | null): uPlot.Range.MinMax {
  if (low === null || high === null) return [0, 1];
  const pad = high > low ? 0.08 * (high - low) : Math.max(1e-300, Math.abs(high)) * 0.1 || 1;
  return [low - pad, high + pad];
}

function keyEntry(text: string, paint: string, mark: string): HTMLElement {
  const entry = document.createElement('span');
  const i = document.createElement('i');
  i.style.color = paint;
  i.className = mark;
  entry.append(i, text);
  return entry;
}

function markOf(s: Series): string {
  return s.style === 'dots' || s.style === 'stems' ? 'dot' : s.style === 'rings' ? 'ring' : '';
}

function key(series: Series[]): HTMLElement {
  const out = document.createElement('div');
  out.className = 'key';
  for (const s of series) out.append(keyEntry(s.label, s.paint, markOf(s)));
  return out;
}

/** Values under the mouse, in the key. */
function tell(out: HTMLElement, d: Diagram, index: number | null | undefined): void {
  out.replaceChildren();
  for (const s of d.series) {
    const value = index === null || index === undefined ? null : s.values[index];
    if (index !== null && index !== undefined && value === null && s.style !== 'line' && s.style !== undefined) continue;
    out.append(keyEntry(index === null || index === undefined ? s.label : `${s.label} ${short(value, 6)}`, s.paint, markOf(s)));
  }
  if (index !== null && index !== undefined) out.prepend(keyEntry(`${d.xLabel} ${d.x[index]}`, 'transparent', ''));
}

function diagramsOf(header: Header): Diagram[] {
  const out: Diagram[] = [];
  const { steps, iterations: it } = header;
  const paint = (k: number) => colour(paints[k % paints.length]);
  const x = steps.map((s) => s.step);
  const count = it.iteration.length;
  const global = Array.from({ length: count }, (_, i) => i + 1);
  if (steps.length > 1) {
    const names = [...new Set(steps.flatMap((s) => Object.keys(s.energies)))];
    const parts = names.length > 1 ? names.map((name, k) => ({ label: name, values: steps.map((s) => s.energies[name] ?? null), paint: paint(k + 1) })) : [];
    out.push({ id: 'energy', title: 'Energy', remark: 'by load step', x, xLabel: 'load step', steps: true, series: [{ label: 'total', values: steps.map((s) => s.energy), paint: paint(0) }, ...parts] });
  } else if (count > 0) {
    const accepted = it.energy.map((e, i) => (it.accepted[i] ? e : null));
    out.push({ id: 'energy', title: 'Energy', remark: 'by iteration', x: global, xLabel: 'iteration', series: [{ label: 'energy', values: accepted, paint: paint(0) }] });
  }
  const probes = [...new Set(steps.flatMap((s) => Object.keys(s.probes)))];
  if (probes.length > 0 && steps.length > 1) {
    const series: Series[] = [];
    for (const name of probes) {
      const length = Math.max(...steps.map((s) => s.probes[name]?.length ?? 0));
      for (let c = 0; c < length; ++c) {
        const suffix = length === 1 ? '' : length === 3 ? ` ${'xyz'[c]}` : ` ${c + 1}`;
        series.push({ label: name + suffix, values: steps.map((s) => s.probes[name]?.[c] ?? null), paint: paint(series.length) });
      }
    }
    out.push({ id: 'probes', title: 'Probes', remark: 'by load step', x, xLabel: 'load step', steps: true, series });
  }
  if (count > 0) {
    const cuts = global.filter((_, i) => i > 0 && it.load_step[i] !== it.load_step[i - 1]).map((i) => i - 0.5);
    const rejected = it.accepted.some((a) => !a);
    const only = (values: (number | null)[], wanted: boolean) => values.map((v, i) => (Boolean(it.accepted[i]) === wanted ? v : null));
    out.push({ id: 'gradient', title: 'Gradient norm', remark: 'by iteration', x: global, xLabel: 'iteration', logarithmic: true, cuts, series: [{ label: 'gradient norm', values: it.gradient_norm, paint: paint(0) }] });
    const series: Series[] = [{ label: 'accepted', values: only(it.step_norm, true), paint: paint(2), style: 'dots' }];
    if (rejected) series.push({ label: 'rejected', values: only(it.step_norm, false), paint: colour('--bad'), style: 'rings' });
    out.push({ id: 'steps', title: 'Step norm', remark: rejected ? 'by iteration' : 'by iteration, none rejected', x: global, xLabel: 'iteration', logarithmic: true, cuts, series });
  }
  if (steps.length > 0) {
    const negative = steps.map((s) => (s.negative_eigenvalues < 0 ? null : s.negative_eigenvalues));
    const known = negative.filter((n) => n !== null) as number[];
    const remark = known.length === 0 ? 'not known' : steps.length === 1 ? String(known[0]) : known.every((n) => n === 0) ? 'none in any load step' : 'by load step';
    const series: Series[] = [{ label: 'of the Hessian at the end of the step', values: negative, paint: paint(3), style: 'stems' }];
    out.push({ id: 'inertia', title: 'Negative eigenvalues', remark, x, xLabel: 'load step', steps: true, height: 110, series: known.length > 0 && steps.length > 1 ? series : [] });
  }
  return out;
}
