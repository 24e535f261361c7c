// The figure of an experiment, where its kind has one: the paper's, or what its trials are recorded for.

import { get } from "../app/api.js";
import { h, panel, replace } from "../ui/dom.js";
import { FIGURES, SAMPLED } from "./figurekinds.js";
import { colour, SERIES } from "../ui/colours.js";
import { draw } from "../plots/plotly.js";
import { shownUnit, titled } from "../ui/units.js";

const LAID_OVER = 6; // trials at most, of those that are drawn from their samples
const POINTS = 2000;
const EFFORTS = ["current_a", "current_estimate_a"];

export async function figureOf(place, kind, trials) {
  replace(place);
  const made = SAMPLED.includes(kind) ? await currentOverSpeed(trials) : FIGURES[kind]?.(trials);
  const groups = made?.groups.filter((one) => one.x.length) ?? [];
  if (!groups.length) return;
  const plot = h("div", { class: "plot", role: "figure", "aria-label": made.title });
  replace(place, panel(made.title, h("p", { class: "soft" }, made.text), plot));
  const type = made.logarithmic ? "log" : undefined;
  await draw(plot, groups.map((one, at) => trace(one, at, made)), { height: 340, shapes: made.diagonal ? [diagonal(groups)] : [],
    xaxis: { title: { text: made.x }, type }, yaxis: { title: { text: made.y }, rangemode: "tozero" } });
}

function trace(one, at, { columns }) {
  const shown = colour(one.colour ?? SERIES[at % SERIES.length]);
  const common = { x: one.x, y: one.y, name: one.name, showlegend: true };
  if (columns) return { ...common, type: "bar", marker: { color: shown } };
  return { ...common, mode: "markers", marker: { color: shown, size: one.size ?? 9, symbol: one.symbol ?? "circle" }, error_y: bars(one) };
}

function bars({ y, low, high }) {
  if (!low) return undefined;
  return { type: "data", symmetric: false, array: high.map((value, at) => value - y[at]), arrayminus: low.map((value, at) => y[at] - value) };
}

function diagonal(groups) {
  const most = Math.max(...groups.flatMap((one) => [...one.x, ...one.y]), 1);
  return { type: "line", x0: 0, y0: 0, x1: most, y1: most, line: { color: colour("soft"), dash: "dot" } };
}

async function currentOverSpeed(trials) {
  const usable = trials.filter((trial) => trial.rows && trial.channels.includes("velocity_rad_s")).slice(0, LAID_OVER);
  const { factor } = shownUnit("rad/s");
  const groups = await Promise.all(usable.map(async (trial) => {
    const { channels } = await get(`/trials/${trial.trial_id}/samples`, { channels: ["velocity_rad_s", ...EFFORTS.filter((name) => trial.channels.includes(name))].join(","), points: POINTS });
    const effort = EFFORTS.map((name) => channels[name]).find((values) => values?.some(Number.isFinite)) ?? [];
    return { name: trial.name, x: effort.length ? channels.velocity_rad_s.map((value) => value === null ? null : value * factor) : [], y: effort, size: 3 };
  }));
  return { title: "Current over speed", x: titled("speed", "rad/s"), y: "current [A]", groups,
    text: `Friction is the step where the speed changes its sign, viscous friction the slope beside it; what opens a loop is inertia, or memory.${trials.length > LAID_OVER ? ` The first ${LAID_OVER} trials.` : ""}` };
}
