// What is missing: the verdict in a sentence, the class of effects that these data cannot tell apart, and each effect with its picture.

import { bar } from "./beforeafter.js";
import { h, replace } from "../ui/dom.js";
import { capital, chance as chanceIs, interval, nameOf, number, percent, spoken } from "../ui/format.js";
import { shownUnit } from "../ui/units.js";
import { colour } from "../ui/colours.js";
import { band, draw } from "../plots/plotly.js";

const SHOWN = 6;
const spaced = (names) => names.map((name) => name.replaceAll("_", " "));

export async function diagnosis(place, found, add) {
  const named = h("div", { class: "cards" });
  const others = h("div", { class: "cards" });
  const curve = found.provisional && h("div", { class: "cards" });
  const more = h("details", {}, h("summary", {}, `${Math.max(0, found.ranking.length - SHOWN)} more effects`), h("div", { class: "cards" }));
  const problems = found.findings.filter(({ code }) => code === "data-problem");
  const notJudged = found.findings.filter(({ code }) => code === "not-judged");
  const notes = found.findings.filter((one) => !problems.includes(one) && !notJudged.includes(one));
  const first = found.ranking.slice(0, SHOWN);
  replace(place, h("p", { class: "sentence", role: "status" }, spoken(found.sentence)),
    problems.map(({ text }) => h("div", { class: "problem" }, capital(spoken(text)))),
    notes.map(({ text }) => h("p", { class: "soft" }, capital(spoken(text)))),
    found.classes.map(className), curve, named, first.some((one) => !one.in_class) && folded(found, others),
    found.ranking.length > SHOWN && more,
    notJudged.length > 0 && h("details", {}, h("summary", {}, `${notJudged.length} effects could not be judged on these trials`), notJudged.map(({ text }) => h("p", { class: "soft" }, spoken(text)))));
  if (curve) await provisional(curve, found.provisional, add);
  for (const one of first) await card(one.in_class ? named : others, one, add);
  more.addEventListener("toggle", async () => {
    const rest = more.querySelector(".cards");
    if (more.open && !rest.children.length) for (const one of found.ranking.slice(SHOWN)) await card(rest, one, add);
  });
}

// what is named comes first; where nothing is, what was tested is shown at once
function folded(found, others) {
  return h("details", { open: !found.classes.length }, h("summary", {}, found.classes.length ? "Less likely" : "Tested"), others);
}

function className(one) {
  return h("div", { class: "good" }, h("strong", {}, spaced(one.effects).join(" or ")), h("p", {}, one.sentence),
    one.separating_trial && h("p", { class: "soft" }, `The trial that would tell: ${one.separating_trial}`));
}

async function card(parent, one, add) {
  const plot = h("div", { class: "plot", role: "figure", "aria-label": `Residual against ${one.picture?.driver ?? "its driver"} with the curve of ${one.title}` });
  const answer = h("div");
  const highest = Math.max(one.held_out_before ?? 0, one.held_out_after ?? 0) || 1;
  const button = h("button", { type: "button", class: one.in_class ? "primary" : "", onclick: () => add(one.effect, answer) }, `Add ${one.title}`);
  parent.append(h("article", { class: "panel", "aria-label": one.title }, h("h3", {}, one.title, " ",
    one.in_class && h("span", { class: "badge completed" }, "candidate"), one.physical ? null : h("span", { class: "badge stale" }, "unphysical sign")),
  h("div", { class: "bars" }, bar("held-out error now", one.held_out_before, highest, "purple"), bar("with the effect", one.held_out_after, highest, "blue")),
  h("p", {}, evidence(one)), one.picture && plot, button, answer));
  if (one.picture) await picture(plot, one);
}

// what has no formula: its curve, to stand in the model until somebody knows the physics
async function provisional(parent, one, add) {
  const plot = h("div", { class: "plot", role: "figure", "aria-label": `Residual against ${one.picture.driver} with the free curve` });
  const answer = h("div");
  const highest = Math.max(one.held_out_before ?? 0, one.held_out_after ?? 0) || 1;
  const button = h("button", { type: "button", class: "primary", onclick: () => add(one.effect, answer) }, "Add as a provisional term");
  parent.append(h("article", { class: "panel", "aria-label": one.title }, h("h3", {}, one.title, " ", h("span", { class: "badge stale" }, "provisional")),
    h("div", { class: "bars" }, bar("held-out error now", one.held_out_before, highest, "purple"), bar("with the curve", one.held_out_after, highest, "blue")),
    h("p", {}, spoken(one.sentence)), plot, button, answer));
  await picture(plot, one);
}

// the evidence in words, the numbers behind it in brackets
export function evidence(one) {
  const gain = `The held-out error would ${one.gain >= 0 ? "fall" : "rise"} by ${interval(Math.abs(one.gain), ...ends(one), (value) => percent(value, 1))}.`;
  const sure = one.gain_low > 0 ? "All of the interval is a gain." : "The interval includes no gain at all.";
  const pays = one.score > 0 ? "" : " Its evidence does not pay for its parameters.";
  const chance = one.p_value === null || one.p_value === undefined ? "" : ` Chance alone would do as well with p ${chanceIs(one.p_value)}.`;
  const sign = one.physical ? "" : " Its fitted sign or size is not physical.";
  const like = one.confused_with.length ? ` These data confuse it with ${spaced(one.confused_with).join(", ")} (d′ = ${number(one.d_prime, 2)}; from 6 on the name is sure).` : "";
  return `${gain} ${sure}${pays}${chance}${sign}${like}`;
}

function ends({ gain, gain_low: low, gain_high: high }) {
  if (low === null || low === undefined) return [null, null];
  return gain >= 0 ? [low, high] : [-high, -low];
}

function picture(plot, { picture: shown, title }) {
  const { unit, factor } = shownUnit(shown.unit);
  const x = shown.x.map((value) => factor * value);
  return draw(plot, [
    band(x, shown.low, shown.high, "residual", "blue"),
    { x, y: shown.residual, name: "residual", mode: "markers", marker: { color: colour("blue"), size: 6 } },
    { x: shown.curve_x.map((value) => factor * value), y: shown.curve, name: title, mode: "lines", line: { color: colour("red"), width: 3 } },
  ], { height: 240, xaxis: { title: { text: `${nameOf(shown.driver)}${unit ? ` [${unit}]` : ""}` } }, yaxis: { title: { text: shown.against_motion ? "residual, against the motion" : "residual" } } });
}
