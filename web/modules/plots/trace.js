// One line onto a canvas. Where it covers the picture rather than crosses it, a bar for each column of pixels: a stroke
// costs as much as its length on the screen, and a second of noise may be longer than a hundred pictures are wide.

import { GAP } from "./thin.js";

const STROKED = 4; // times the picture's width: the longest line that is stroked
const WIDTH = 1.6;

// points: {x, y} in pixels, NaN where the line is interrupted
export function points(indices, line, xOf, yOf) {
  const x = new Float64Array(indices.length);
  const y = new Float64Array(indices.length);
  indices.forEach((index, at) => {
    x[at] = index === GAP ? NaN : xOf(line.x[index]);
    y[at] = index === GAP ? NaN : yOf(line.y[index]);
  });
  return { x, y };
}

// dots: a square at each point; bare: these alone
export function drawTrace(context, { x, y }, { colour, dash = [], width = WIDTH, dots = false, bare = false }, box, pixel = 1) {
  context.strokeStyle = colour;
  context.fillStyle = colour;
  if (!dots && lengthOf({ x, y }) > STROKED * (box.right - box.left)) barred(context, columns({ x, y }, box, pixel), dash, width, box, pixel);
  else stroked(context, { x, y }, dash, width, dots, bare);
}

// how long the line is on the screen, up and down
export function lengthOf({ x, y }) {
  let length = 0;
  for (let at = 1; at < x.length; at += 1) if (y[at] === y[at] && y[at - 1] === y[at - 1]) length += Math.abs(y[at] - y[at - 1]);
  return length;
}

// lowest and highest y of the line in each column of pixels; high below low where it is not
export function columns({ x, y }, { left, right }, pixel = 1) {
  const count = Math.ceil((right - left) / pixel);
  const low = new Float64Array(count).fill(Infinity);
  const high = new Float64Array(count).fill(-Infinity);
  const take = (column, value) => {
    if (column < 0 || column >= count) return;
    if (value < low[column]) low[column] = value;
    if (value > high[column]) high[column] = value;
  };
  for (let at = 0; at < x.length; at += 1) {
    const column = Math.floor((x[at] - left) / pixel);
    take(column, y[at]);
    if (at === 0 || !(x[at] - x[at - 1] > 0)) continue;
    // between two samples the line is straight: where it goes from column to column, both have that height
    const slope = (y[at] - y[at - 1]) / (x[at] - x[at - 1]);
    const last = Math.min(column, count);
    for (let edge = Math.max(0, Math.floor((x[at - 1] - left) / pixel) + 1); edge <= last; edge += 1) {
      const height = y[at - 1] + slope * (left + edge * pixel - x[at - 1]);
      take(edge, height);
      take(edge - 1, height);
    }
  }
  return { low, high };
}

// one path of lines as wide as a pixel: browsers draw these at once, wider ones as outlines to be filled
function barred(context, { low, high }, dash, width, box, pixel) {
  const period = dash.reduce((sum, one) => sum + one, 0);
  context.lineWidth = pixel;
  context.setLineDash([]);
  context.beginPath();
  for (let column = 0; column < low.length; column += 1) {
    if (low[column] > high[column] || (period && (column * pixel) % period >= dash[0])) continue;
    const x = box.left + (column + 0.5) * pixel;
    context.moveTo(x, low[column] - width / 2);
    context.lineTo(x, high[column] + width / 2);
  }
  context.stroke();
}

function stroked(context, { x, y }, dash, width, dots, bare) {
  context.lineWidth = width;
  context.lineJoin = "bevel";
  context.setLineDash(dash);
  context.beginPath();
  let down = false;
  for (let at = 0; at < x.length; at += 1) {
    if (y[at] === y[at]) {
      if (down && !bare) context.lineTo(x[at], y[at]);
      else context.moveTo(x[at], y[at]);
      if (!down && !bare && !Number.isFinite(y[at + 1])) context.lineTo(x[at] + width, y[at]); // alone between two gaps
      if (dots) context.rect(x[at] - 3, y[at] - 3, 6, 6);
      if (dots) context.moveTo(x[at], y[at]);
      down = true;
    } else down = false;
  }
  context.stroke();
  if (dots) context.fill();
}
