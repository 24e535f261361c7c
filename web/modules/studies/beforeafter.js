// What a change did: the held-out error before and after as bars, the same stretch of a trial before and after, and undo.

import { h, replace } from "../ui/dom.js";
import { interval, percent } from "../ui/format.js";
import { SeriesPlot } from "./seriesplot.js";

export function beforeAfter(place, result, { before, after, undo }) {
  const picture = h("div");
  const highest = Math.max(result.before.held_out ?? 0, result.after.held_out ?? 0, result.before.training ?? 0, result.after.training ?? 0) || 1;
  const rows = [["held-out error before", result.before.held_out, "purple"], ["held-out error after", result.after.held_out, "blue"],
    ["training error before", result.before.training, "purple"], ["training error after", result.after.training, "blue"]];
  replace(place, h("div", { class: "good", role: "status" }, result.sentence),
    h("div", { class: "bars" }, rows.map(([text, value, colour]) => bar(text, value, highest, colour))),
    h("p", { class: "soft" }, `Gain ${interval(result.gain, result.gain_low, result.gain_high, (value) => percent(value, 1))} of the held-out error, 90 % interval.`),
    h("div", { class: "row" }, h("button", { type: "button", onclick: undo }, "Undo this change")), picture);
  // the held-out trials judge: the one that gained most is shown first
  return new SeriesPlot(picture, { series: gained(before, after), earlier: before.series, effort: after.effort, label: "Effort and residual before and after the change" });
}

export function bar(text, value, highest, colour) {
  const filled = h("span", { class: `fill ${colour}` });
  filled.style.width = `${(100 * (value ?? 0)) / highest}%`;
  return h("div", { class: "bar" }, h("span", { class: "soft" }, text), h("span", { class: "track", "aria-hidden": "true" }, filled), h("span", { class: "number" }, percent(value)));
}

function gained(before, after) {
  const error = (compared, trial_id) => compared.trials.find((one) => one.trial_id === trial_id)?.rms ?? 0;
  const held = new Set(after.trials.filter((one) => one.role === "held_out").map((one) => one.trial_id));
  const gain = (one) => error(before, one.trial_id) - error(after, one.trial_id) + (held.has(one.trial_id) ? 1e6 : 0);
  return [...after.series].sort((one, other) => gain(other) - gain(one));
}
