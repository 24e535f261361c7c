// What is missing: the verdict in a sentence, classes that these data cannot tell apart, and each effect with its picture.

import { h, replace } from "./dom.js";
import { interval, nameOf, number, percent } from "./format.js";
import { band, colour, draw } from "./plot.js";

const SHOWN = 6;

export async function diagnosis(place, found, add) {
  const cards = h("div", { class: "cards" });
  const more = h("details", {}, h("summary", {}, `${Math.max(0, found.ranking.length - SHOWN)} more effects`), h("div", { class: "cards" }));
  replace(place, h("p", { class: "sentence", role: "status" }, found.sentence),
    found.data_problems.map((problem) => h("div", { class: "problem" }, problem)),
    found.notes.map((note) => h("p", { class: "soft" }, note)), found.classes.map(className), cards,
    found.ranking.length > SHOWN && more);
  for (const one of found.ranking.slice(0, SHOWN)) await card(cards, one, add);
  more.addEventListener("toggle", async () => {
    const rest = more.querySelector(".cards");
    if (more.open && !rest.children.length) for (const one of found.ranking.slice(SHOWN)) await card(rest, one, add);
  });
}

function className(one) {
  return h("div", { class: "good" }, h("strong", {}, one.effects.map((name) => name.replaceAll("_", " ")).join(" or ")), h("p", {}, one.sentence),
    one.separating_trial && h("p", { class: "soft" }, `The trial that would tell: ${one.separating_trial}`));
}

async function card(parent, one, add) {
  const plot = h("div", { class: "plot", role: "img", "aria-label": `Residual against ${one.picture?.driver ?? "its driver"} with the curve of ${one.title}` });
  const answer = h("div");
  const button = h("button", { type: "button", class: one.in_class ? "primary" : "", onclick: () => add(one.effect, answer) }, `Add ${one.title}`);
  parent.append(h("article", { class: "panel", "aria-label": one.title }, h("h3", {}, one.title, " ",
    one.in_class && h("span", { class: "badge completed" }, "candidate"), one.physical ? null : h("span", { class: "badge stale" }, "unphysical sign")),
  h("p", {}, one.sentence), one.picture && plot,
  h("p", { class: "soft" }, `Held-out error ${percent(one.held_out_before)} → ${percent(one.held_out_after)}, gain ${interval(one.gain, one.gain_low, one.gain_high, (value) => percent(value, 1))}. `,
    `p = ${number(one.p_value, 2)}, d′ = ${number(one.d_prime, 2)}.`,
    one.confused_with.length > 0 && ` Easily confused with: ${one.confused_with.map((name) => name.replaceAll("_", " ")).join(", ")}.`),
  button, answer));
  if (one.picture) await picture(plot, one);
}

function picture(plot, { picture: shown, title }) {
  return draw(plot, [
    band(shown.x, shown.low, shown.high, "residual", "blue"),
    { x: shown.x, y: shown.residual, name: "residual", mode: "markers", marker: { color: colour("blue"), size: 6 } },
    { x: shown.curve_x, y: shown.curve, name: title, mode: "lines", line: { color: colour("red"), width: 3 } },
  ], { height: 240, xaxis: { title: { text: `${nameOf(shown.driver)}${shown.unit ? ` [${shown.unit}]` : ""}` } }, yaxis: { title: { text: shown.against_motion ? "residual, against the motion" : "residual" } } });
}
