// Trials: experiments, their trials, plots, files; the paper's figures; recording sets in and out.

import { get } from "./api.js";
import { calibrations } from "./calibrations.js";
import { h, panel, replace, table } from "./dom.js";
import { figureOf } from "./figures.js";
import { outcome, withFiles } from "./files.js";
import { when } from "./format.js";
import { attempt } from "./problem.js";
import { importForm } from "./recordingsets.js";
import { trialPlot } from "./trialplot.js";
import { trialTable } from "./trialtable.js";

const MOST = 1000;
const OUTCOMES = ["", "completed", "stopped", "tripped", "failed", "interrupted", "refused", "running"];

export function trialsView(place) {
  const [experiments, list, detail, figure, curves] = ["div", "div", "div", "div", "div"].map((tag) => h(tag));
  const filter = { experiment_id: "", outcome: "" };
  let trials = [];
  let plotted = null;
  const words = h("input", { type: "search", id: "trial-search", placeholder: "name, kind, condition …", oninput: () => shown() });
  const change = (name) => ({ target }) => {
    filter[name] = target.value.trim();
    show();
  };
  const number = h("input", { inputMode: "numeric", placeholder: "all", onchange: change("experiment_id") });
  const bar = h("div", { class: "row" }, h("label", {}, "Experiment", number), h("label", { for: "trial-search" }, "Search", words),
    h("label", {}, "Outcome", h("select", { onchange: change("outcome") }, OUTCOMES.map((name) => h("option", { value: name }, name || "any")))));
  const plot = async (ids) => {
    plotted?.close();
    plotted = await trialPlot(detail, ids);
  };
  const shown = () => trialTable(list, trials, words.value, plot);
  const show = () => attempt(list, async () => {
    trials = (await get("/trials", { ...filter, limit: MOST })).items;
    shown();
    await figureOf(figure, filter.experiment_id ? kindOf(trials) : null, trials);
  });
  const choose = (id) => {
    filter.experiment_id = String(id);
    number.value = filter.experiment_id;
    return show();
  };
  const refresh = () => attempt(experiments, async () => {
    const { items } = await get("/experiments", { limit: 100 });
    replace(experiments, experimentTable(items, choose));
    const latest = items.find((one) => one.outcome !== "refused");
    await (latest ? choose(latest.experiment_id) : show());
  });
  replace(place, panel("Experiments", experiments, importForm(refresh)), panel("Trials", bar, h("div", { class: "gap" }), list), detail, figure, curves);
  refresh();
  calibrations(curves);
  return () => plotted?.close();
}

// of all of them, whatever they came in by
function kindOf(trials) {
  const kinds = new Set(trials.map((trial) => trial.kind));
  return kinds.size === 1 ? [...kinds][0] : null;
}

function experimentTable(items, choose) {
  if (!items.length) return h("p", { class: "soft" }, "Nothing has been run yet. Start an experiment on the Bench, or import a recording set.");
  return table("Experiments", [
    { title: "Experiment", number: true, cell: (one) => one.experiment_id },
    { title: "Kind", cell: (one) => one.kind },
    { title: "Source", cell: (one) => h("span", { class: `badge ${one.source}` }, one.source) },
    { title: "Started", cell: (one) => when(one.started_utc) },
    { title: "Outcome", cell: (one) => outcome(one) },
    { title: "Note", cell: (one) => [one.note || one.parameters.name || "", one.tags?.length > 0 && h("div", { class: "hint" }, one.tags.join(", "))].filter(Boolean) },
    { title: "", cell: (one) => withFiles(
      [h("button", { class: "small", type: "button", "aria-label": `Trials of experiment ${one.experiment_id}`, onclick: () => choose(one.experiment_id) }, "Trials")],
      [["Export", `Recording set of experiment ${one.experiment_id}`, `/experiments/${one.experiment_id}/recording-set`, `experiment-${one.experiment_id}.zip`],
        ["Parquet", `Parquet of experiment ${one.experiment_id}`, `/experiments/${one.experiment_id}/parquet`, `experiment-${one.experiment_id}.parquet`]]) },
  ], items);
}
