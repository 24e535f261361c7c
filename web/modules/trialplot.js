// One trial: any channels over time or over another channel, events marked, results beside it.

import { get } from "./api.js";
import { facts, h, panel, replace } from "./dom.js";
import { conditions, number, withUnit } from "./format.js";
import { SERIES, colour, draw } from "./plot.js";
import { attempt } from "./problem.js";

const POINTS = 4000;
const FIRST = ["position_rad", "target_rad", "position_m", "target_m"];
const EFFORTS = ["current_estimate_a", "current_a", "torque_n_m", "force_n", "duty"];

export async function trialPlot(place, { trial_id: id }) {
  const answer = h("div");
  replace(place, answer);
  const trial = await attempt(answer, () => get(`/trials/${id}`));
  if (!trial) return;
  const names = trial.channels.filter((name) => name !== "time_s");
  const effort = EFFORTS.find((name) => names.includes(name));
  const boxes = names.map((name) => h("input", { type: "checkbox", value: name, checked: FIRST.includes(name) || name === effort }));
  const against = h("select", {}, trial.channels.map((name) => h("option", { value: name }, withUnit(name))));
  const plot = h("div", { class: "plot", role: "img", "aria-label": `Channels of trial ${id}` });
  const show = () => attempt(answer, async () => {
    const chosen = boxes.filter((box) => box.checked).map((box) => box.value);
    const channels = [...new Set([against.value, ...chosen])].join(",");
    const samples = await get(`/trials/${id}/samples`, { channels, points: POINTS });
    await drawChannels(plot, samples.channels, against.value, chosen, trial.events);
  });
  for (const box of [...boxes, against]) box.addEventListener("change", show);
  const choices = h("fieldset", {}, h("legend", {}, "Channels"),
    h("div", { class: "row centre" }, boxes.map((box) => h("label", { class: "inline" }, box, withUnit(box.value))),
      h("label", { class: "inline" }, "over", against)));
  replace(place, panel(`Trial ${id}: ${trial.name}`, h("p", { class: "soft" }, `${trial.outcome}${trial.reason ? `: ${trial.reason}` : ""}. ${conditions(trial.conditions)}`),
    results(trial.results), choices, answer, plot));
  await show();
  place.scrollIntoView({ behavior: "smooth", block: "nearest" });
}

function drawChannels(plot, columns, against, chosen, events) {
  const units = [...new Set(chosen.map((name) => withUnit(name).split("[")[1] ?? ""))];
  const height = Math.max(280, 200 * units.length);
  const share = 1 / Math.max(1, units.length);
  const axes = Object.fromEntries(units.map((unit, index) => [`yaxis${index ? index + 1 : ""}`,
    { domain: [1 - (index + 1) * share + 0.04 * (index < units.length - 1), 1 - index * share], title: { text: unit.replace("]", "") } }]));
  const traces = chosen.map((name, index) => {
    const row = units.indexOf(withUnit(name).split("[")[1] ?? "");
    const absent = columns[name].every((value) => value === null);
    return { x: columns[against], y: columns[name], name: absent ? `${withUnit(name)}: not measured` : withUnit(name), showlegend: true, mode: against === "time_s" ? "lines" : "markers", marker: { size: 3 },
      yaxis: `y${row ? row + 1 : ""}`, line: { color: colour(SERIES[index % SERIES.length]), width: 1.5 } };
  });
  const shapes = against !== "time_s" ? [] : events.slice(0, 200).map((event) => (
    { type: "line", x0: event.time_s, x1: event.time_s, yref: "paper", y0: 0, y1: 1, line: { color: colour("soft"), width: 1, dash: "dot" } }));
  const last = units.length > 1 ? `y${units.length}` : "y";
  return draw(plot, traces, { height, shapes, xaxis: { title: { text: withUnit(against) }, anchor: last }, ...axes, uirevision: against });
}

function results(values) {
  const entries = Object.entries(values ?? {}).filter(([, value]) => ["number", "string", "boolean"].includes(typeof value));
  if (!entries.length) return null;
  return h("details", {}, h("summary", {}, "Results"), facts(entries.map(([name, value]) => [withUnit(name), number(value)])));
}
