// The ladder: relative error of each model, training and held-out, down towards the floor.
// The name of a model in the ladder: its number, and what it was changed by.

import { h, replace, table } from "../ui/dom.js";
import { interval, number, percent } from "../ui/format.js";
import { colour } from "../ui/colours.js";
import { draw } from "../plots/plotly.js";
import { floorOf } from "./verdict.js";

const AXIS_PX = 72; // what the axis at the left takes
const WORD_PX = 76; // of the longest words of effects

export function ladderPlot(place, ladder, current) {
  const plot = h("div", { class: "plot ladder", role: "figure", "aria-label": "Error of each model; the table below holds the numbers" });
  const floor = floorOf(ladder.floor);
  replace(place, plot, rungTable(ladder, current),
    floor !== null && h("p", { class: "soft" }, `Floor: repeated trials differ by ${percent(floor)} among themselves, as far as the best model can tell. Only an effect with memory can go below.`));
  const names = ladder.rungs.map(rungName);
  const held = ladder.rungs.map((rung) => 100 * rung.held_out);
  const traces = [
    { x: names, y: held, name: "held-out", mode: "lines+markers", marker: { size: 10, symbol: "circle" }, line: { color: colour("blue"), width: 3 },
      error_y: spread(ladder.rungs) },
    { x: names, y: ladder.rungs.map((rung) => 100 * rung.training), name: "training", mode: "lines+markers", marker: { size: 8, symbol: "diamond" },
      line: { color: colour("orange"), width: 2, dash: "dash" } },
  ];
  const shapes = floor === null ? [] : [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: 100 * floor, y1: 100 * floor, line: { color: colour("green"), dash: "dot", width: 2 } }];
  const annotations = floor === null ? [] : [{ xref: "paper", x: 0, xanchor: "left", y: 100 * floor, text: "floor", showarrow: false, yanchor: "bottom", font: { color: colour("green") } }];
  whenShown(plot, () => draw(plot, traces, { height: 280, width: plot.clientWidth, shapes, annotations, xaxis: namesBeneath(plot, names), yaxis: { title: { text: "relative error [%]" }, rangemode: "tozero" } }));
}

// what is drawn while its step is not shown would have no width: it waits, and follows the width of its card
function whenShown(plot, paint) {
  let drawn = 0;
  new ResizeObserver(() => {
    if (!plot.clientWidth || plot.clientWidth === drawn) return;
    drawn = plot.clientWidth;
    paint();
  }).observe(plot);
}

// half a place on both sides, and a line for each word, so that the last name ends within the picture; where there is
// no room for words, the numbers of the models alone: the table beneath has their names
function namesBeneath(plot, names) {
  const room_px = (plot.clientWidth - AXIS_PX) / names.length;
  const ticktext = names.map((name) => (room_px < WORD_PX ? name.split(":")[0] : name.replace(/(?<![+−]) /g, "<br>")));
  return { type: "category", range: [-0.5, names.length - 0.5], tickvals: names, ticktext, tickangle: 0 };
}

function spread(rungs) {
  if (rungs.some((rung) => rung.held_out_low === null || rung.held_out_low === undefined)) return undefined;
  return { type: "data", symmetric: false, array: rungs.map((rung) => 100 * Math.max(0, rung.held_out_high - rung.held_out)),
    arrayminus: rungs.map((rung) => 100 * Math.max(0, rung.held_out - rung.held_out_low)), color: colour("blue"), thickness: 1.5 };
}

function rungTable(ladder, current) {
  const rows = ladder.rungs.map((rung) => ({ ...rung, chosen: rung.model_id === current }));
  return table("Ladder", [
    { title: "Model", cell: rungName },
    { title: `Training error, ${ladder.rows}`, number: true, cell: (rung) => percent(rung.training) },
    { title: `Held-out error, ${ladder.rows}`, number: true, cell: (rung) => interval(rung.held_out, rung.held_out_low, rung.held_out_high) },
    ...(rows.some((rung) => rung.breakaway) ? [{ title: "Breakaway, held out", number: true, cell: (rung) => percent(rung.breakaway?.held_out) }] : []),
    ...(rows.some((rung) => rung.motion) ? [{ title: "Position in closed loop, rms", number: true, cell: (rung) => (rung.motion ? `${number(rung.motion.position, 3)} ${rung.motion.unit}` : "") }] : []),
  ], rows);
}

export function rungName(rung) {
  const change = [...[rung.added ?? []].flat().map((name) => `+ ${name}`), ...[rung.removed ?? []].flat().map((name) => `− ${name}`)];
  return `${rung.model_id}: ${change.join(", ").replaceAll("_", " ") || "base"}`;
}
