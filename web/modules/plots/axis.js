// Round numbers for an axis.
// The part of an axis that is shown: moved and zoomed within what there is.

const STEPS = [1, 2, 5, 10];

// the values to write at an axis from low to high, about `wanted` of them
export function ticks(low, high, wanted = 5) {
  const step = stepOf(high - low, wanted);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, index) => rounded((first + index) * step, step));
}

// the smallest interval between ticks that holds low and high: it changes seldom while values move
export function widened(low, high, wanted = 5) {
  if (!(low <= high)) return [0, 1];
  const span = high - low || Math.max(Math.abs(high), 1e-3);
  const middle = (low + high) / 2;
  const [from, to] = high === low ? [middle - span / 2, middle + span / 2] : [low, high];
  const step = stepOf(span, wanted);
  return [rounded(Math.floor(from / step + 1e-9) * step, step), rounded(Math.ceil(to / step - 1e-9) * step, step)];
}

export function label(value, step) {
  const places = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return (places > 8 || Math.abs(value) >= 1e6 ? value.toExponential(1) : value.toFixed(places)).replace("-", "−");
}

function stepOf(span, wanted) {
  const raw = Math.abs(span) / wanted || 1;
  const power = 10 ** Math.floor(Math.log10(raw));
  return power * STEPS.find((one) => one * power >= raw * (1 - 1e-9));
}

function rounded(value, step) {
  const places = Math.min(100, Math.max(0, 2 - Math.floor(Math.log10(step))));
  return Number(value.toFixed(places)) + 0;
}

const LEAST_SHARE = 1e-6;

export function whole(lines) {
  let [low, high] = [Infinity, -Infinity];
  for (const { x } of lines) {
    if (!x.length) continue;
    low = Math.min(low, x[0]);
    high = Math.max(high, x[x.length - 1]);
  }
  if (!(low <= high)) return [0, 1];
  return low === high ? [low - 0.5, high + 0.5] : [low, high];
}

export function moved([from, to], share, limits) {
  return within([from + share * (to - from), to + share * (to - from)], limits);
}

// factor below 1 zooms in; `centre` stays where it is
export function zoomed([from, to], factor, centre, limits) {
  const least = LEAST_SHARE * (limits[1] - limits[0]);
  const scale = Math.max(factor, least / (to - from));
  return within([centre - (centre - from) * scale, centre + (to - centre) * scale], limits);
}

export function within([from, to], [low, high]) {
  const size = Math.min(to - from, high - low);
  const start = Math.min(Math.max(from, low), high - size);
  return [start, start + size];
}
