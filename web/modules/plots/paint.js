// Draws rows of lines over a common axis onto a canvas. Pure: what is drawn follows from the arguments.

import { label, ticks, widened } from "./axis.js";
import { extremes, thinned } from "./thin.js";
import { columns, drawTrace, points } from "./trace.js";

const LEFT = 78;
const RIGHT = 10;
const TOP = 8;
const BOTTOM = 34;
const BETWEEN = 16;
const EDGE = 2; // of the picture, that words keep clear of
const NOTHING = [0, 1];

// where row `index` of `count` stands in a picture of that size
export function frame(index, count, width, height) {
  const each = (height - TOP - BOTTOM - BETWEEN * (count - 1)) / count;
  return { left: LEFT, right: width - RIGHT, top: TOP + index * (each + BETWEEN), bottom: TOP + index * (each + BETWEEN) + each };
}

export function xOf(value, [from, to], box) {
  return box.left + ((value - from) / (to - from)) * (box.right - box.left);
}

export function valueAt(x, [from, to], box) {
  return from + ((x - box.left) / (box.right - box.left)) * (to - from);
}

// content: {rows: [{title, least}], lines: [{row, x, y, colour, dash, width, dots, bare}], bands, marks, shades, xTitle}; theme: colours and font; pixel: how large one of the screen is
export function paint(context, { width, height, view, content, theme, pointer, pixel = 1 }) {
  context.clearRect(0, 0, width, height);
  context.font = theme.font;
  content.rows.forEach((row, index) => {
    const box = frame(index, content.rows.length, width, height);
    const { lines, bands } = of(content, index);
    const range = rangeOf(lines, bands, view, box, row.least);
    grid(context, box, range, view, theme, index === content.rows.length - 1);
    title(context, row.title, box, theme, content.rows.length > 1 ? box.bottom - box.top + BETWEEN : height);
    clipped(context, box, () => {
      for (const shade of content.shades ?? []) shaded(context, shade, view, box, theme);
      for (const band of bands) banded(context, band, view, range, box, pixel);
      for (const mark of content.marks ?? []) marked(context, mark, view, box, theme);
      for (const line of lines) drawn(context, line, view, range, box, pixel);
      if (pointer !== null) vertical(context, xOf(pointer, view, box), box, theme.soft, []);
    });
    if (index === 0) for (const mark of content.marks ?? []) flag(context, mark, view, box, theme);
  });
  context.fillStyle = theme.text;
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  words(context, content.xTitle, (LEFT + width - RIGHT) / 2, height - 4, width);
}

// centred where that fits between 0 and `room`, else moved; what is longer than that is drawn narrower
function words(context, text, centre, y, room) {
  const half = Math.min(context.measureText(text).width, room - 2 * EDGE) / 2;
  context.fillText(text, Math.min(Math.max(centre, half + EDGE), room - half - EDGE), y, room - 2 * EDGE);
}

function of(content, index) {
  return { lines: content.lines.filter((line) => line.row === index), bands: (content.bands ?? []).filter((band) => band.row === index) };
}

// the point of any line that is nearest to a place in the picture, {line, index}; null where there is none
export function nearest({ x, y }, { width, height, view, content }) {
  let [found, least] = [null, Infinity];
  content.rows.forEach((row, at) => {
    const box = frame(at, content.rows.length, width, height);
    const { lines, bands } = of(content, at);
    const range = rangeOf(lines, bands, view, box, row.least);
    for (const line of lines) for (let index = 0; index < line.x.length; index += 1) {
      const away = Math.hypot(xOf(line.x[index], view, box) - x, yOf(line.y[index], range, box) - y);
      if (away < least) [found, least] = [{ line: content.lines.indexOf(line), index }, away];
    }
  });
  return found;
}

// least: what the axis spans at least, so that the noise of what stands still is not drawn as large as motion
function rangeOf(lines, bands, view, box, least = 0) {
  let [low, high] = [Infinity, -Infinity];
  const take = ([a, b]) => {
    low = Math.min(low, a);
    high = Math.max(high, b);
  };
  for (const line of lines) take(extremes(line.x, line.y, view));
  for (const band of bands) for (const edge of [band.low, band.high]) take(extremes(band.x, edge, view));
  if (!(low <= high)) return NOTHING;
  const short = Math.max(0, least - (high - low)) / 2;
  return widened(low - short, high + short, wanted(box));
}

function wanted(box) {
  return Math.max(2, Math.round((box.bottom - box.top) / 34));
}

function yOf(value, [low, high], box) {
  return box.bottom - ((value - low) / (high - low)) * (box.bottom - box.top);
}

function grid(context, box, range, view, theme, last) {
  context.lineWidth = 1;
  context.setLineDash([]);
  context.textBaseline = "middle";
  context.textAlign = "right";
  // one value alone would say nothing of the scale
  const across = [0, 1, 2, 3].map((more) => ticks(...range, wanted(box) + more)).find((found) => found.length > 1) ?? ticks(...range, wanted(box));
  for (const value of across) {
    const y = Math.round(yOf(value, range, box)) + 0.5;
    path(context, box.left, y, box.right, y, value === 0 ? theme.soft : theme.line);
    context.fillStyle = theme.text;
    context.fillText(label(value, across[1] - across[0] || 1), box.left - 6, y);
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  const along = ticks(...view, Math.max(2, Math.round((box.right - box.left) / 60)));
  for (const value of along) {
    const x = Math.round(xOf(value, view, box)) + 0.5;
    path(context, x, box.top, x, box.bottom, theme.line);
    context.fillStyle = theme.text;
    if (last) context.fillText(label(value, along[1] - along[0] || 1), x, box.bottom + 5);
  }
}

// room: how much of the picture's height it may take, about the middle of its row
function title(context, text, box, theme, room) {
  const middle = (box.top + box.bottom) / 2;
  const top = Math.max(0, middle - room / 2);
  context.save();
  context.translate(11, top + room);
  context.rotate(-Math.PI / 2);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillStyle = theme.text;
  words(context, text, top + room - middle, 0, room);
  context.restore();
}

function clipped(context, box, draw) {
  context.save();
  context.beginPath();
  context.rect(box.left, box.top - 1, box.right - box.left, box.bottom - box.top + 2);
  context.clip();
  draw();
  context.restore();
}

function drawn(context, line, view, range, box, pixel) {
  const wanted = thinned(line.x, line.y, view, (box.right - box.left) / pixel);
  drawTrace(context, points(wanted, line, (value) => xOf(value, view, box), (value) => yOf(value, range, box)), line, box, pixel);
}

// a bar for each column of pixels: from the lowest of the lower edge to the highest of the upper one
function banded(context, band, view, range, box, pixel) {
  const edge = (y) => {
    const wanted = thinned(band.x, y, view, (box.right - box.left) / pixel);
    return columns(points(wanted, { x: band.x, y }, (value) => xOf(value, view, box), (value) => yOf(value, range, box)), box, pixel);
  };
  const [lower, upper] = [edge(band.low), edge(band.high)];
  context.fillStyle = band.colour;
  context.beginPath();
  for (let column = 0; column < upper.low.length; column += 1) {
    const [top, bottom] = [upper.low[column], lower.high[column]];
    if (top <= bottom) context.rect(box.left + column * pixel, top, pixel, bottom - top);
  }
  context.fill();
}

function shaded(context, shade, view, box, theme) {
  const left = xOf(shade.from, view, box);
  context.fillStyle = theme.shade;
  context.fillRect(left, box.top, Math.max(2, xOf(shade.to, view, box) - left), box.bottom - box.top);
}

function marked(context, mark, view, box, theme) {
  vertical(context, xOf(mark.x, view, box), box, theme[mark.colour] ?? theme.soft, [2, 3]);
}

// the name of a mark, at its head; a letter each, as there may be many: the list beside the plot spells them out
function flag(context, mark, view, box, theme) {
  if (!mark.letter || mark.x < view[0] || mark.x > view[1]) return;
  context.fillStyle = theme[mark.colour] ?? theme.soft;
  const x = xOf(mark.x, view, box);
  const fits = x + 2 + context.measureText(mark.letter).width <= box.right;
  context.textAlign = fits ? "left" : "right";
  context.textBaseline = "top";
  context.fillText(mark.letter, fits ? x + 2 : x - 2, box.top);
}

function vertical(context, x, box, colour, dash) {
  context.lineWidth = 1;
  context.setLineDash(dash);
  path(context, x, box.top, x, box.bottom, colour);
}

function path(context, x0, y0, x1, y1, colour) {
  context.strokeStyle = colour;
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
