// Fewer points than pixels ask for, none of the extremes lost: of each pixel column the first, lowest, highest and last sample.

export const GAP = -1;

// index of the first value that is not below `wanted`, in rising values
export function firstFrom(values, wanted) {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (values[middle] < wanted) low = middle + 1;
    else high = middle;
  }
  return low;
}

// indices from .. to of rising x that lie in a view, and one more on both sides, so that lines leave the picture
export function span(x, [from, to]) {
  return [Math.max(0, firstFrom(x, from) - 1), Math.min(x.length, firstFrom(x, to) + 1)];
}

// indices of the points to draw; GAP where values are missing
export function thinned(x, y, view, width) {
  const [first, last] = span(x, view);
  const found = [];
  if (last - first <= 4 * width) {
    for (let index = first; index < last; index += 1) put(found, Number.isFinite(y[index]) ? index : GAP);
    return found;
  }
  const perPixel = width / (view[1] - view[0]);
  let index = first;
  while (index < last) {
    const pixel = Math.floor((x[index] - view[0]) * perPixel);
    const begin = index;
    while (index < last && Math.floor((x[index] - view[0]) * perPixel) === pixel) index += 1;
    column(y, begin, index, found);
  }
  return found;
}

export function extremes(x, y, view) {
  const [first, last] = span(x, view);
  let low = Infinity;
  let high = -Infinity;
  for (let index = first; index < last; index += 1) {
    if (y[index] < low) low = y[index];
    if (y[index] > high) high = y[index];
  }
  return [low, high];
}

function column(y, begin, end, found) {
  let low = GAP;
  let high = GAP;
  let missing = false;
  for (let index = begin; index < end; index += 1) {
    if (!Number.isFinite(y[index])) missing = true;
    else {
      if (low === GAP || y[index] < y[low]) low = index;
      if (high === GAP || y[index] > y[high]) high = index;
    }
  }
  if (low === GAP) put(found, GAP);
  else {
    const wanted = [begin, Math.min(low, high), Math.max(low, high), end - 1].filter((index) => Number.isFinite(y[index]));
    for (const index of wanted) if (found.at(-1) !== index) found.push(index);
    if (missing) put(found, GAP);
  }
}

function put(found, index) {
  if (index !== GAP || (found.length && found.at(-1) !== GAP)) found.push(index);
}
