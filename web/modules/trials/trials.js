// Trials: experiments, their trials, plots, files; the paper's figures; recording sets in and out.

import { get } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { calibrations } from "./calibrations.js";
import { h, panel, replace } from "../ui/dom.js";
import { experimentList } from "./experimentlist.js";
import { figureOf } from "./figures.js";
import { importForm } from "./recordingsets.js";
import { trialPlot } from "./trialplot.js";
import { trialTable } from "./trialtable.js";

const MOST = 1000;
const OUTCOMES = ["", "completed", "stopped", "tripped", "failed", "interrupted", "refused", "running"];

export function trialsView(place) {
  const [experiments, list, detail, figure, curves] = ["div", "div", "div", "div", "div"].map((tag) => h(tag));
  const filter = { experiment_id: "", outcome: "" };
  let [trials, more] = [[], false];
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
  const shown = () => trialTable(list, { trials, more }, words.value, plot);
  const show = () => attempt(list, async () => {
    const page = await get("/trials", { ...filter, limit: MOST });
    [trials, more] = [page.items, page.next_offset !== null];
    shown();
    await figureOf(figure, filter.experiment_id ? kindOf(trials) : null, trials);
  });
  const choose = (id) => {
    filter.experiment_id = String(id);
    number.value = filter.experiment_id;
    return show();
  };
  const { refresh: listAgain } = experimentList(experiments, choose);
  const refresh = async () => {
    const latest = (await listAgain())?.find((one) => one.outcome !== "refused");
    await (latest ? choose(latest.experiment_id) : show());
  };
  replace(place, panel("Experiments", experiments, importForm(refresh)), panel("Trials", bar, h("div", { class: "gap" }), list), detail, figure, curves);
  together(place, [refresh(), calibrations(curves)]);
  return () => plotted?.close();
}

// of all of them, whatever they came in by
function kindOf(trials) {
  const kinds = new Set(trials.map((trial) => trial.kind));
  return kinds.size === 1 ? [...kinds][0] : null;
}
