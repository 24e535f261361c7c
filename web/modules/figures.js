// The paper's figures, of trials whose kind has one: repeated steps (Fig. 4), load sweeps (Table 1).

import { h, panel, replace } from "./dom.js";
import { colour, draw } from "./plot.js";

const FIGURES = { steps: repeatedSteps, "load-sweep": loadSweep };

export async function figureOf(place, kind, trials) {
  replace(place);
  const made = FIGURES[kind]?.(trials);
  if (!made || !made.traces[0].x.length) return;
  const plot = h("div", { class: "plot", role: "figure", "aria-label": made.title });
  replace(place, panel(made.title, h("p", { class: "soft" }, made.text), plot));
  await draw(plot, made.traces, { height: 340, shapes: made.shapes ?? [], xaxis: { title: { text: made.x } }, yaxis: { title: { text: made.y } } });
}

const points = (x, y, name, colourName, symbol, more = {}) => ({ x, y, name, mode: "markers", showlegend: true, marker: { color: colour(colourName), size: 9, symbol }, ...more });

export function bars(values, intervals) {
  if (intervals.some((one) => !one)) return undefined;
  return { type: "data", symmetric: false, array: intervals.map((one, at) => one[1] - values[at]), arrayminus: intervals.map((one, at) => values[at] - one[0]) };
}

function repeatedSteps(trials) {
  const known = trials.filter((trial) => typeof trial.results?.load_current_a === "number");
  const speed = known.map((trial) => trial.conditions.approach_rad_s);
  const load = known.map((trial) => trial.results.load_current_a);
  return { title: "Repeated steps: the current at rest, and the load's share of it (Fig. 4)", x: "speed of the approach [rad/s]", y: "current [A]",
    text: "Friction holds the joint wherever it comes to rest, so the current differs from step to step; what the zero-speed search finds does not.",
    traces: [points(speed, known.map((trial) => trial.results.steady_current_a), "current at rest", "orange", "circle"),
      points(speed, load, "of the load alone", "blue", "diamond", { error_y: bars(load, known.map((trial) => trial.results.load_interval_a)) })] };
}

function loadSweep(trials) {
  const known = trials.filter((trial) => typeof trial.results?.reflected_load_kg === "number");
  const grams = (value) => 1000 * value;
  const hung = known.map((trial) => grams(trial.conditions.load_kg));
  const seen = known.map((trial) => grams(trial.results.reflected_load_kg));
  const most = Math.max(...hung, ...seen, 1);
  const intervals = known.map((trial) => trial.results.reflected_interval_kg?.map(grams));
  return { title: "Load sweep: the load that is reflected, over the load that hangs there (Table 1)", x: "load hung [g]", y: "load found [g]",
    text: "On the line, the load is found as it is. Bars: 95 %.",
    traces: [points(hung, seen, "found", "blue", "circle", { error_y: bars(seen, intervals) })],
    shapes: [{ type: "line", x0: 0, y0: 0, x1: most, y1: most, line: { color: colour("soft"), dash: "dot" } }] };
}
