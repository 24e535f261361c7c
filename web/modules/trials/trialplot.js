// One trial, or several laid over each other: which channels, over what, results beside them.

import { get } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { facts, h, panel, replace } from "../ui/dom.js";
import { conditions, nameOf, quantity, withUnit } from "../ui/format.js";
import { replay } from "../joint/replay.js";
import { markLegend, marksOf } from "../plots/marks.js";
import { Overlay } from "./overlay.js";

const FIRST = ["position_rad", "target_rad", "position_m", "target_m"];
const EFFORTS = ["current_estimate_a", "current_a", "torque_n_m", "force_n", "duty"];

// returns what has to be closed when another one comes
export async function trialPlot(place, ids) {
  const answer = h("div");
  replace(place, answer);
  const trials = await attempt(answer, () => Promise.all(ids.map((id) => get(`/trials/${id}`))));
  if (!trials) return null;
  const names = [...new Set(trials.flatMap((trial) => trial.channels))];
  const effort = EFFORTS.find((name) => names.includes(name));
  const boxes = names.filter((name) => name !== "time_s").map((name) => h("input", { type: "checkbox", value: name, checked: FIRST.includes(name) || name === effort }));
  const against = h("select", {}, names.map((name) => h("option", { value: name }, withUnit(name))));
  const plot = h("div", { "aria-label": `Channels of trial ${ids.join(", ")}`, role: "group" });
  const joint = h("div", { class: "trial-joint", hidden: !(trials.length === 1 && names.includes("position_rad")) });
  const choices = h("fieldset", {}, h("legend", {}, "Channels"),
    h("div", { class: "row centre" }, boxes.map((box) => h("label", { class: "inline" }, box, withUnit(box.value))), h("label", { class: "inline" }, "over", against)));
  replace(place, panel(trials.length > 1 ? `Trials ${ids.join(", ")}` : `Trial ${ids[0]}: ${trials[0].name}`, trials.map(heading), choices, h("div", { class: "trial-now" }, joint, plot)));
  const overlay = new Overlay(plot, trials);
  const show = () => overlay.show(boxes.filter((box) => box.checked).map((box) => box.value), against.value);
  for (const box of [...boxes, against]) box.addEventListener("change", show);
  await show();
  if (!joint.hidden) {
    const stop = replay(joint, trials[0], { chart: overlay.chart, limits: () => overlay.limits, at: (time_s) => overlay.at(time_s) });
    const close = overlay.close.bind(overlay);
    overlay.close = () => {
      stop();
      close();
    };
  }
  place.scrollIntoView({ behavior: "smooth", block: "nearest" });
  return overlay;
}

function heading(trial) {
  const why = trial.reason ? `: ${trial.reason}` : "";
  const marks = markLegend(marksOf(trial.events));
  return [h("p", { class: "soft" }, `${trial.name}: ${trial.outcome}${why}. ${conditions(trial.conditions)}${marks ? `. Marks: ${marks}` : ""}`), results(trial)];
}

function results(trial) {
  const entries = Object.entries(trial.results ?? {}).filter(([, value]) => ["number", "string", "boolean"].includes(typeof value));
  if (!entries.length) return null;
  return h("details", {}, h("summary", {}, `Results of ${trial.name}`), facts(entries.map(([name, value]) => [nameOf(name), quantity(name, value)])));
}
