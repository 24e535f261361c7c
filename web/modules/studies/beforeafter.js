// What a change did: the held-out error before and after as bars, and undo; the plot beside it shows both.

import { h, replace } from "../ui/dom.js";
import { interval, percent, spoken } from "../ui/format.js";

export function beforeAfter(place, result, { undo }) {
  const highest = Math.max(result.before.held_out ?? 0, result.after.held_out ?? 0, result.before.training ?? 0, result.after.training ?? 0) || 1;
  // an effect with memory is judged on more rows than the ladder counts: each error says which it is of
  const wider = result.rows !== result.ladder_rows;
  const of = (rows) => (wider ? `, ${rows}` : "");
  const inLadder = wider ? [[`held-out error before${of(result.ladder_rows)}`, result.ladder_before, "purple"], [`held-out error after${of(result.ladder_rows)}`, result.ladder_after, "blue"]] : [];
  const rows = [[`held-out error before${of(result.rows)}`, result.before.held_out, "purple"], [`held-out error after${of(result.rows)}`, result.after.held_out, "blue"], ...inLadder,
    ["training error before", result.before.training, "purple"], ["training error after", result.after.training, "blue"]];
  replace(place, h("div", { class: "good", role: "status" }, spoken(result.sentence)),
    h("div", { class: "bars" }, rows.map(([text, value, colour]) => bar(text, value, highest, colour))),
    h("p", { class: "soft" }, `Gain ${interval(result.gain, result.gain_low, result.gain_high, (value) => percent(value, 0))} of the held-out error, 90 % interval.`),
    h("div", { class: "row" }, h("button", { type: "button", onclick: undo }, "Undo this change")));
}

export function bar(text, value, highest, colour) {
  const filled = h("span", { class: `fill ${colour}` });
  filled.style.width = `${(100 * (value ?? 0)) / highest}%`;
  return h("div", { class: "bar" }, h("span", { class: "soft" }, text), h("span", { class: "track", "aria-hidden": "true" }, filled), h("span", { class: "number" }, percent(value)));
}
