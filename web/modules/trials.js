// Trials: experiments, their trials, plots, CSV; recording sets in and out.

import { download, get } from "./api.js";
import { h, panel, replace, table } from "./dom.js";
import { conditions, number, when } from "./format.js";
import { attempt } from "./problem.js";
import { importForm } from "./recordingsets.js";
import { trialPlot } from "./trialplot.js";

const PAGE = 50;
const OUTCOMES = ["", "completed", "stopped", "tripped", "failed", "interrupted", "refused", "running"];

export function trialsView(place) {
  const experiments = h("div");
  const list = h("div");
  const detail = h("div");
  const filter = { experiment_id: "", kind: "", outcome: "", offset: 0 };
  const bar = filters(filter, () => show());
  const plot = (trial) => trialPlot(detail, trial);
  const show = () => attempt(list, async () => {
    const page = await get("/trials", { ...filter, limit: PAGE });
    replace(list, trialTable(page, plot), pager(page, filter, show));
  });
  const choose = (id) => {
    filter.experiment_id = String(id);
    filter.offset = 0;
    bar.querySelector("input").value = filter.experiment_id;
    return show();
  };
  const refresh = () => attempt(experiments, async () => {
    const { items } = await get("/experiments", { limit: 100 });
    replace(experiments, experimentTable(items, choose));
    const latest = items.find((one) => one.outcome !== "refused");
    await (latest ? choose(latest.experiment_id) : show());
  });
  replace(place, panel("Experiments", experiments, importForm(refresh)), panel("Trials", bar, list), detail);
  refresh();
  return () => {};
}

function experimentTable(items, choose) {
  if (!items.length) return h("p", { class: "soft" }, "Nothing has been run yet. Start an experiment on the Bench, or import a recording set.");
  return table("Experiments", [
    { title: "Experiment", number: true, cell: (one) => one.experiment_id },
    { title: "Kind", cell: (one) => one.kind },
    { title: "Source", cell: (one) => h("span", { class: `badge ${one.source}` }, one.source) },
    { title: "Started", cell: (one) => when(one.started_utc) },
    { title: "Outcome", cell: (one) => outcome(one) },
    { title: "Note", cell: (one) => one.note || one.parameters.name },
    { title: "", cell: (one) => actions(
      h("button", { class: "small", type: "button", "aria-label": `Trials of experiment ${one.experiment_id}`, onclick: () => choose(one.experiment_id) }, "Trials"),
      fetchButton("Export", `Export experiment ${one.experiment_id}`, `/experiments/${one.experiment_id}/recording-set`, `experiment-${one.experiment_id}.zip`)) },
  ], items);
}

function filters(filter, show) {
  const change = (name) => (event) => {
    filter[name] = event.target.value.trim();
    filter.offset = 0;
    show();
  };
  return h("div", { class: "row" },
    h("label", {}, "Experiment", h("input", { inputMode: "numeric", placeholder: "all", onchange: change("experiment_id") })),
    h("label", {}, "Kind", h("input", { placeholder: "any", onchange: change("kind") })),
    h("label", {}, "Outcome", h("select", { onchange: change("outcome") }, OUTCOMES.map((name) => h("option", { value: name }, name || "any")))));
}

function trialTable(page, plot) {
  if (!page.items.length) return h("p", { class: "soft" }, "No trials match.");
  return table("Trials", [
    { title: "Trial", number: true, cell: (trial) => trial.trial_id },
    { title: "Name", cell: (trial) => trial.name },
    { title: "Kind", cell: (trial) => trial.kind },
    { title: "Conditions", cell: (trial) => conditions(trial.conditions) },
    { title: "Outcome", cell: (trial) => outcome(trial) },
    { title: "Rows", number: true, cell: (trial) => number(trial.rows) },
    { title: "", cell: (trial) => actions(
      h("button", { class: "small", type: "button", "aria-label": `Plot trial ${trial.trial_id}`, onclick: () => plot(trial) }, "Plot"),
      fetchButton("CSV", `CSV of trial ${trial.trial_id}`, `/trials/${trial.trial_id}/csv`, `trial-${trial.trial_id}.csv`)) },
  ], page.items);
}

function outcome(one) {
  return [h("span", { class: `badge ${one.outcome}` }, one.outcome), one.reason && h("div", { class: "hint" }, one.reason)].filter(Boolean);
}

// problems of the buttons appear beneath them
function actions(...buttons) {
  return [h("div", { class: "actions" }, ...buttons), h("div")];
}

function fetchButton(text, label, path, name) {
  const fetchFile = ({ currentTarget: button }) => attempt(button.parentElement.nextElementSibling, () => download(path, name), { button });
  return h("button", { class: "small", type: "button", "aria-label": label, onclick: fetchFile }, text);
}

function pager(page, filter, show) {
  if (page.offset === 0 && page.next_offset === null) return null;
  const go = (offset) => () => {
    filter.offset = offset;
    show();
  };
  return h("div", { class: "row centre" },
    h("button", { type: "button", disabled: page.offset === 0, onclick: go(Math.max(0, page.offset - PAGE)) }, "Earlier"),
    h("span", {}, `${page.offset + 1} to ${page.offset + page.items.length}`),
    h("button", { type: "button", disabled: page.next_offset === null, onclick: go(page.next_offset) }, "Later"));
}
