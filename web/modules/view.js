// The part of an axis that is shown: moved and zoomed within what there is.

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
