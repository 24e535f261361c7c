// What is missing: the verdict in a sentence, the class of effects that these data cannot tell apart, and each effect with its picture.

import { get } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { bar } from "./beforeafter.js";
import { h, replace } from "../ui/dom.js";
import { capital, interval, nameOf, number, percent, spoken } from "../ui/format.js";
import { allShown, milli, titled } from "../ui/units.js";
import { Chart } from "../plots/chart.js";
import { momentList } from "./errormap.js";

const SHOWN = 6;
const ORDER = "those confirmed by their own numbers first, then by score";
const NOTABLE = 0.01; // of a gain
const UNLIKE = "Gains count each row by how well it is known, errors count all alike; effects near reversals and at starts from rest have errors of their own rows.";
const MOMENTS = 4; // of a candidate: all have the same to say
const spaced = (names) => names.map((name) => name.replaceAll("_", " "));

// add(effect, place): to the model; finish: what to press where nothing is left to add; linked: the plots that show where an effect acts, or null; path: of the study
export function diagnosis(place, found, { add, finish, path, linked, effort }) {
  const ways = { add, look: (one, answer, button) => look(answer, one, { path, linked, model_id: found.model_id, button }), linked, effort, slight: found.slight };
  const named = h("div", { class: "cards" });
  const others = h("div", { class: "cards" });
  const curve = found.provisional && h("div", { class: "cards" });
  const more = h("details", {}, h("summary", {}, `${Math.max(0, found.ranking.length - SHOWN)} more effects`), h("div", { class: "cards" }));
  const problems = found.findings.filter(({ code }) => code === "data-problem");
  const notJudged = found.findings.filter(({ code }) => code === "not-judged");
  const notes = found.findings.filter((one) => !problems.includes(one) && !notJudged.includes(one));
  const first = found.ranking.slice(0, SHOWN);
  replace(place, h("p", { class: "sentence", role: "status" }, spoken(found.slight ? found.advice : found.sentence)),
    found.slight && h("p", { class: "soft" }, spoken(found.sentence)),
    (found.slight || found.verdict === "nothing") && h("div", { class: "row finish" }, finish),
    problems.map(({ text }) => h("div", { class: "problem" }, capital(spoken(text)))),
    notes.map(({ text }) => h("p", { class: "soft" }, capital(spoken(text)))),
    !found.slight && found.classes.map(className), curve, named, first.some((one) => !one.in_class) && folded(found, others),
    found.ranking.length > SHOWN && more, found.ranking.some(isUnlike) && h("p", { class: "soft" }, UNLIKE),
    notJudged.length > 0 && h("details", {}, h("summary", {}, `${notJudged.length} effects could not be judged on these trials`), notJudged.map(({ text }) => h("p", { class: "soft" }, spoken(text)))));
  if (curve) provisional(curve, found.provisional, ways);
  for (const one of first) card(one.in_class ? named : others, one, ways);
  more.addEventListener("toggle", () => {
    const rest = more.querySelector(".cards");
    if (more.open && !rest.children.length) for (const one of found.ranking.slice(SHOWN)) card(rest, one, ways);
  });
}

// a gain that is notably not what the two errors have
function isUnlike({ gain, held_out_before: before, held_out_after: after }) {
  return before > 0 && Math.abs(gain - (1 - after / before)) > NOTABLE;
}

// what is named comes first; where nothing is, what was tested is shown at once
function folded(found, others) {
  return h("details", { open: !found.classes.length }, h("summary", {}, `${found.classes.length ? "Less likely" : "Tested"}: ${ORDER}`), others);
}

function className(one) {
  return h("div", { class: "good" }, h("strong", {}, spaced(one.effects).join(" or ")), h("p", {}, one.sentence),
    one.separating_trial && h("p", { class: "soft" }, `The trial that would tell: ${one.separating_trial}`));
}

function card(parent, one, ways) {
  const candidate = one.in_class && !ways.slight;
  const badges = [candidate && h("span", { class: "badge completed" }, "candidate"), one.badge && h("span", { class: "badge stale" }, one.badge)];
  article(parent, one, { badges, words: evidence(one), name: "with the effect", action: `Add ${one.title}`, primary: candidate }, ways);
}

// what has no formula: its curve, to stand in the model until somebody knows the physics
function provisional(parent, one, ways) {
  const badges = [h("span", { class: "badge stale" }, "provisional")];
  article(parent, one, { badges, words: spoken(one.sentence), name: "with the curve", action: "Add as a provisional term", primary: false }, ways);
}

function article(parent, one, { badges, words, name, action, primary }, { add, look: lookAt, linked, effort }) {
  const [plot, answer] = [h("div"), h("div")];
  const highest = Math.max(one.held_out_before ?? 0, one.held_out_after ?? 0) || 1;
  const adding = h("button", { type: "button", class: primary ? "add primary" : "add", onclick: () => add(one.effect, answer) }, action);
  const looking = h("button", { type: "button", "aria-label": `Show where ${one.title} acts`, onclick: () => lookAt(one, answer, looking) }, "Show where it acts");
  parent.append(h("article", { class: "panel", "aria-label": one.title }, h("h3", {}, one.title, " ", badges),
    h("div", { class: "bars" }, bar("held-out error now", one.held_out_before, highest, "purple"), bar(name, one.held_out_after, highest, "blue")),
    h("p", {}, words), plot, h("div", { class: "row" }, adding, linked && looking), answer));
  if (!one.picture) return;
  const chart = picture(plot, one, effort);
  if (!linked) return;
  chart.addEventListener("choose", () => lookAt(one, answer, looking));
  linked.over(chart, one.picture.driver);
}

// the plots beside it show the moment in which the effect takes most away, with and without it
async function look(place, { effect, title }, { path, linked, model_id, button }) {
  const found = await attempt(place, () => get(`${path}/action`, { effect, model_id }), { busy: "Fitting the model with it …", button });
  if (!found) return;
  if (!found.items.length) {
    replace(place, h("p", { class: "soft", role: "status" }, `${title} changes no prediction of the moving joint: what it says is of breaking away from rest.`));
    return;
  }
  const { series } = linked;
  series.withEffect(found);
  momentList(place, `Where ${title} takes most away`, { ...found, items: found.items.slice(0, MOMENTS) }, (one) => series.showMoment(one));
  series.showMoment(found.items[0], { focus: false });
}

const NEXT_TO_NOTHING = 5e-4; // of the error: less is shown as no change
const SURE = 6; // d′ from which a name is sure

// the evidence in words, the numbers behind it in brackets
export function evidence(one) {
  const lacks = one.why_not.length ? ` Not named: ${one.why_not.join(", ")}.` : "";
  return `${gained(one)}${lacks}${one.confused_with.length ? ` ${alike(one)}` : ""}`;
}

function gained(one) {
  const [low, high] = ends(one);
  const show = (value) => percent(value, 0); // as the sentence above has it
  if (Math.abs(one.gain) < NEXT_TO_NOTHING) {
    const wide = Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0)) >= NEXT_TO_NOTHING;
    return `No change of the held-out error${wide ? ` (${show(one.gain_low)} to ${show(one.gain_high)} less)` : ""}.`;
  }
  const sure = one.gain_low > 0 ? "All of the interval is a gain." : "The interval includes no gain at all.";
  return `The held-out error would ${one.gain >= 0 ? "fall" : "rise"} by ${interval(Math.abs(one.gain), low, high, show)}. ${sure}`;
}

// an effect that is sure of its name may still take the evidence of another one away
function alike({ confused_with, d_prime }) {
  const names = spaced(confused_with).join(", ");
  if (d_prime >= SURE) return `With it in the model, little is left that speaks for ${names}; its own curve is told from theirs (d′ = ${number(d_prime, 2)}).`;
  return `These data confuse it with ${names} (d′ = ${number(d_prime, 2)}; from ${SURE} on the name is sure).`;
}

function ends({ gain, gain_low: low, gain_high: high }) {
  if (low === null || low === undefined) return [null, null];
  return gain >= 0 ? [low, high] : [-high, -low];
}

// the residual, each bin's mean with its band, and the curve of the effect over it
function picture(place, { picture: shown, title }, effort) {
  const small = milli(Math.max(...[...shown.low, ...shown.high, ...shown.curve].map(Math.abs)), effort.unit);
  const scaled = (values) => values.map((value) => small.factor * value);
  const x = allShown(shown.x, shown.unit);
  const chart = new Chart(place, { label: `Residual against ${nameOf(shown.driver)} with the curve of ${title}`, height: 230, moves: false });
  chart.show({ rows: [{ title: `residual${shown.against_motion ? " against motion" : ""} [${small.unit}]` }], xTitle: titled(nameOf(shown.driver), shown.unit),
    bands: [{ row: 0, x, low: scaled(shown.low), high: scaled(shown.high), colour: "blue" }],
    lines: [{ row: 0, name: "residual", x, y: scaled(shown.residual), colour: "blue", dots: true, bare: true },
      { row: 0, name: title, x: allShown(shown.curve_x, shown.unit), y: scaled(shown.curve), colour: "red", width: 3 }] });
  return chart;
}
