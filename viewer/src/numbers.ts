// Numbers as text.

/** Short and readable: 4 significant digits, powers of ten where that is shorter. */
export function short(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return '–';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-3) return Number(x.toPrecision(digits - 1)).toExponential().replace('e+', 'e').replace(/-/g, '−');
  return String(Number(x.toPrecision(digits))).replace('-', '−');
}

/** Round values that cut [low, high] into about n pieces. */
export function ticks(low: number, high: number, n: number): number[] {
  const raw = (high - low) / Math.max(1, n);
  if (!(raw > 0) || !Number.isFinite(raw)) return [low];
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => s >= raw * 0.999)!;
  const out: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push(k * step);
  return out;
}

export function duration(seconds: number | null | undefined): string {
  if (seconds === null || seconds === undefined || !Number.isFinite(seconds)) return '–';
  if (seconds < 1e-3) return `${(seconds * 1e6).toFixed(0)} µs`;
  if (seconds < 1) return `${(seconds * 1e3).toPrecision(3)} ms`;
  if (seconds < 120) return `${seconds.toPrecision(3)} s`;
  const minutes = seconds / 60;
  return minutes < 120 ? `${minutes.toPrecision(3)} min` : `${(minutes / 60).toPrecision(3)} h`;
}

/** Powers of ten from low to high, at most about n of them. */
export function powers(low: number, high: number, n: number): number[] {
  const from = Math.ceil(Math.log10(low) - 1e-9), to = Math.floor(Math.log10(high) + 1e-9);
  const step = Math.max(1, Math.ceil((to - from) / n));
  const out: number[] = [];
  for (let k = from; k <= to; ++k) if ((k - from) % step === 0) out.push(10 ** k);
  return out;
}
