// The friction-compensated current, what a master arm is given, with its 95 % band.

export const LOAD = "current_load_a";
export const HALF = "current_load_half_width_a";

// the band of a chart round a line; nothing where one of both is not known
export function around(row, x, middle, half, colour) {
  const edge = (way) => Float64Array.from(middle, (value, at) => (Number.isFinite(half[at]) ? value + way * half[at] : NaN));
  return { row, x, low: edge(-1), high: edge(1), colour };
}

// the newest value as it is read
export function newest(rows) {
  const [value, half] = [LOAD, HALF].map((name) => rows.column(name)?.at(-1) ?? NaN);
  if (!Number.isFinite(value)) return null;
  return `${value.toFixed(3)}${Number.isFinite(half) ? ` ± ${half.toFixed(3)}` : ""} A`.replaceAll("-", "−");
}
