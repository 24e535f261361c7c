// Two models beside each other, of one study or of two: #compare/1.3/2.7 is model 3 of study 1 and model 7 of study 2.

import { note } from "../app/address.js";
import { get } from "../app/api.js";
import { rungName } from "../studies/ladder.js";
import { PARAMETER, unitText, writerOf } from "../studies/parameters.js";
import { SeriesPlot } from "../studies/seriesplot.js";
import { attempt, patiently, together } from "../ui/attempt.js";
import { h, panel, replace, table } from "../ui/dom.js";
import { conditions, percent } from "../ui/format.js";

const SIDES = ["first", "second"];

export function versusView(place, { rest }) {
  const wanted = SIDES.map((_, at) => parsed(rest[at]));
  const [choice, answer, said, plot, tables] = ["div", "div", "div", "div", "div"].map((tag) => h(tag));
  replace(place, panel("Two models beside each other", choice, answer, said),
    h("div", { class: "study" }, h("div", {}, tables), h("div", { class: "study-plots" }, panel("Measured against predicted", plot))));
  let series = null;
  const show = async () => {
    note({ view: "compare", rest: wanted.map(written) });
    if (wanted.some((one) => !one.model_id)) return;
    const models = await patiently(answer, "compare", "Fitting, and comparing with every trial …",
      // both at once: the second tells how far it has come
      (signal, job) => Promise.all(wanted.map(({ study_id, model_id }, at) => get(`/studies/${study_id}/compare`, { model_id }, { signal, job: at > 0 ? job : undefined }))));
    if (!models) return;
    const [first, second] = models;
    replace(said, h("p", { class: "sentence", role: "status" }, verdict(first, second)));
    series?.close();
    series = new SeriesPlot(plot, { ...second, series: merged(first, second) });
    series.between(first, { before: `first, ${written(wanted[0])}`, now: `second, ${written(wanted[1])}` });
    replace(tables, panel("Error of each trial", trialTable(first, second)), panel("Parameters", parameterTable(first, second)));
  };
  const first = attempt(answer, async () => {
    const studies = (await get("/studies")).items;
    const sides = await Promise.all(wanted.map((side, at) => sideChoice(side, SIDES[at], studies, show)));
    replace(choice, h("div", { class: "row" }, sides));
    await show();
  });
  together(place, [first]);
  return () => series?.close();
}

// "1.3" -> {study_id: 1, model_id: 3}
export function parsed(text = "") {
  const [study_id, model_id] = text.split(".").map(Number);
  return { study_id: study_id || null, model_id: model_id || null };
}

function written({ study_id, model_id }) {
  return `${study_id ?? ""}.${model_id ?? ""}`;
}

// two selects; `side` holds what is chosen
async function sideChoice(side, name, studies, changed) {
  const model = h("select", { id: `${name}-model`, onchange: () => { side.model_id = Number(model.value); changed(); } });
  const fill = async () => {
    if (!side.study_id) return;
    const { rungs } = await get(`/studies/${side.study_id}/ladder`);
    if (!rungs.some((one) => one.model_id === side.model_id)) side.model_id = rungs.at(-1).model_id;
    replace(model, rungs.map((rung) => h("option", { value: String(rung.model_id), selected: rung.model_id === side.model_id }, rungName(rung))));
  };
  const study = h("select", { id: `${name}-study`, onchange: async () => { side.study_id = Number(study.value); await fill(); changed(); } },
    studies.map((one) => h("option", { value: String(one.study_id), selected: one.study_id === side.study_id }, `${one.study_id}: ${one.name}`)));
  side.study_id ??= Number(study.value) || null;
  await fill();
  return [h("label", { for: study.id }, `The ${name}: study`, study), h("label", { for: model.id }, "its model", model)];
}

// which one is off by less, and on what that rests
export function verdict(first, second) {
  if (first.effort.unit !== second.effort.unit) return `These cannot be compared: one predicts ${first.effort.unit}, the other ${second.effort.unit}.`;
  const [before, now] = [first.error.held_out, second.error.held_out];
  const both = shared(first, second);
  const held = `Held-out error: ${percent(before.relative)} the first, ${percent(now.relative)} the second.`;
  if (!both.length) return `${held} They share no trial, so each is judged on its own trials.`;
  const better = both.filter(([one, other]) => other.relative < one.relative).length;
  return `${held} The second is closer in ${better} of the ${both.length} trials that both use.`;
}

function shared(first, second) {
  return first.trials.map((one) => [one, second.trials.find((other) => other.trial_id === one.trial_id)]).filter(([, other]) => other);
}

// the series of the second, and those that the first alone has, without a prediction of the second
function merged(first, second) {
  const known = new Set(second.series.map((one) => one.trial_id));
  const blank = (one) => ({ ...one, predicted: one.predicted.map(() => null), residual: one.residual.map(() => null) });
  const all = [...second.series, ...first.series.filter((one) => !known.has(one.trial_id)).map(blank)];
  if (shared(first, second).length) return all;
  // trials of two units have the same names
  return all.map((one) => ({ ...one, name: `${one.name}, ${SIDES[known.has(one.trial_id) ? 1 : 0]}` }));
}

function trialTable(first, second) {
  const key = keyOf(first, second);
  const all = [...new Map([...first.trials, ...second.trials].map((one) => [key(one), one])).values()];
  const cell = (model) => (one) => {
    const found = model.trials.find((other) => key(other) === key(one));
    return found ? `${percent(found.relative)} (${found.role.replace("_", " ")})` : "not used";
  };
  return table("Error of each trial", [
    { title: "Trial", cell: (one) => [one.name, h("div", { class: "hint" }, conditions(one.conditions))] },
    { title: "First", number: true, cell: cell(first) },
    { title: "Second", number: true, cell: cell(second) },
  ], all);
}

// which trials stand in one row: one and the same; of studies that share none, such as of two units, what was run alike
export function keyOf(first, second) {
  const alike = ({ name, conditions: { session_s, ...rest } }) => JSON.stringify([name, rest]);
  const isTold = ({ trials }) => new Set(trials.map(alike)).size === trials.length;
  return !shared(first, second).length && isTold(first) && isTold(second) ? alike : (one) => one.trial_id;
}

function parameterTable(first, second) {
  const key = (one) => `${one.effect}.${one.name}`;
  const all = [...new Map([...first.parameters, ...second.parameters].map((one) => [key(one), one])).values()];
  const value = (model) => (one) => {
    const found = model.parameters.find((other) => key(other) === key(one));
    if (!found) return "–";
    const show = writerOf(found);
    return [show(found.value), found.low !== null && h("div", { class: "hint" }, `${show(found.low)} to ${show(found.high)}`)].filter(Boolean);
  };
  return table("Parameters of both models, with 95 % intervals", [
    PARAMETER,
    { title: "Unit", cell: (one) => unitText(one.unit) },
    { title: "First", number: true, cell: value(first) },
    { title: "Second", number: true, cell: value(second) },
  ], all);
}
