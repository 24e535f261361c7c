// The friction-compensated current, what a master arm is given, with its 95 % band.

export const LOAD = "current_load_a";
export const HALF = "current_load_half_width_a";

// the band of a chart round a line; nothing where one of both is not known
export function around(row, x, middle, half, colour) {
  const edge = (way) => Float64Array.from(middle, (value, at) => (Number.isFinite(half[at]) ? value + way * half[at] : NaN));
  return { row, x, low: edge(-1), high: edge(1), colour };
}

// the newest value that is known, as it is read: it is found for a moment of each search, and holds until the next
export function newest(rows) {
  const values = rows.column(LOAD) ?? [];
  let at = values.length - 1;
  while (at >= 0 && !Number.isFinite(values[at])) at -= 1;
  if (at < 0) return null;
  const half = rows.column(HALF)?.[at] ?? NaN;
  return `${values[at].toFixed(3)}${Number.isFinite(half) ? ` ± ${half.toFixed(3)}` : ""} A`.replaceAll("-", "−");
}
