// Live: position and target, speed, current and load current, over the rows that arrive.

import { h, replace } from "./dom.js";
import { number } from "./format.js";
import { colour, draw, forget } from "./plot.js";
import { problemBox } from "./problem.js";

const REDRAW_MS = 200;
const MOST_POINTS = 3000;
const LINES = [
  ["position_rad", "position [rad]", "blue", "y"], ["target_rad", "target [rad]", "orange", "y"],
  ["velocity_rad_s", "speed [rad/s]", "green", "y2"],
  ["current_a", "current [A]", "red", "y3"], ["current_estimate_a", "current from duty [A]", "purple", "y3"],
  ["current_load_a", "load current [A]", "sky", "y3"],
];

export function livePlot(place, live) {
  const progress = h("progress", { max: "1", value: "0", "aria-label": "Progress of the experiment" });
  const outcome = h("p", { class: "soft", role: "status" });
  const values = h("p", { class: "soft number" });
  const nothing = h("p", { class: "soft" }, "No rows yet: they appear here while an experiment runs.");
  const plot = h("div", { class: "plot live", hidden: true, role: "img", "aria-label": "Position, speed and current over the last rows" });
  const freeze = h("input", { type: "checkbox", id: "freeze" });
  replace(place, progress, outcome, h("div", { class: "row centre" }, h("label", { class: "inline" }, freeze, "freeze"), values), nothing, plot);

  let changed = true;
  const mark = () => { changed = true; };
  const status = () => {
    const run = live.status?.run;
    progress.value = run?.progress ?? 0;
    outcome.textContent = run ? sentence(run) : "Nothing has run yet. Start an experiment on the left.";
    values.textContent = reading(live.status?.reading);
  };
  const timer = setInterval(() => {
    if (!changed || freeze.checked || document.hidden) return;
    changed = false;
    plot.hidden = !live.rows.length;
    nothing.hidden = !plot.hidden;
    if (plot.hidden) return;
    draw(plot, traces(live), axes()).catch((error) => replace(nothing, problemBox(error)));
  }, REDRAW_MS);
  live.addEventListener("rows", mark);
  live.addEventListener("status", status);
  status();
  return () => {
    clearInterval(timer);
    live.removeEventListener("rows", mark);
    live.removeEventListener("status", status);
    forget(plot);
  };
}

function traces(live) {
  const step = Math.max(1, Math.ceil(live.rows.length / MOST_POINTS));
  const thin = (values) => values.filter((_, index) => index % step === 0);
  const time = thin(live.column("time_s") ?? []);
  return LINES.flatMap(([channel, name, colourName, yaxis]) => {
    const values = live.column(channel);
    if (!values || values.every((value) => value === null)) return [];
    return [{ x: time, y: thin(values), name, yaxis, mode: "lines", line: { color: colour(colourName), width: 1.5, dash: channel === "target_rad" ? "dash" : "solid" } }];
  });
}

function axes() {
  return {
    height: 520, xaxis: { title: { text: "time in the trial [s]" }, anchor: "y3" },
    yaxis: { domain: [0.70, 1], title: { text: "rad" } }, yaxis2: { domain: [0.36, 0.64], title: { text: "rad/s" } },
    yaxis3: { domain: [0, 0.30], title: { text: "A" } },
  };
}

function sentence(run) {
  if (run.outcome === "running") return `Running ${run.kind}: trial ${run.trial_index + 1} of ${run.trial_count}.`;
  return `Experiment ${run.experiment_id} (${run.kind}): ${run.outcome}${run.reason ? `: ${run.reason}` : ""}`;
}

function reading(values) {
  if (!values) return "";
  const unit = { position_rad: "rad", velocity_rad_s: "rad/s", current_a: "A", duty: "duty", supply_v: "V", temperature_c: "°C" };
  return Object.entries(unit).filter(([name]) => values[name] !== null && values[name] !== undefined)
    .map(([name, text]) => `${number(values[name], 3)} ${text}`).join("   ");
}
