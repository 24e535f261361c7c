// The table of trials: search, choose several to lay over each other, files of each.

import { h, replace, table } from "../ui/dom.js";
import { outcome, withFiles } from "../ui/files.js";
import { conditions, number } from "../ui/format.js";

// every word has to be in it somewhere
export function found(trial, words) {
  const text = [trial.trial_id, trial.name, trial.kind, trial.outcome, trial.reason, conditions(trial.conditions)].join(" ").toLowerCase();
  return words.toLowerCase().split(/\s+/).every((word) => text.includes(word));
}

// more: there are older ones, not among them; plot(ids): one trial, or those that were chosen
export function trialTable(place, { trials, more }, words, plot) {
  const shown = trials.filter((trial) => found(trial, words));
  if (!shown.length) {
    replace(place, h("p", { class: "soft" }, trials.length ? "No trial has all of these words." : "No trials match."));
    return;
  }
  const chosen = new Set();
  const together = h("button", { type: "button", disabled: true, onclick: () => plot([...chosen]) }, "Lay the chosen over each other");
  const box = (trial) => h("input", { type: "checkbox", "aria-label": `Choose trial ${trial.trial_id}`, onchange: ({ target }) => {
    if (target.checked) chosen.add(trial.trial_id);
    else chosen.delete(trial.trial_id);
    together.disabled = chosen.size < 2;
  } });
  replace(place, table("Trials", [
    { title: "", unseen: "Choose", cell: box },
    { title: "Trial", number: true, cell: (trial) => trial.trial_id },
    { title: "Name", cell: (trial) => trial.name },
    { title: "Kind", cell: (trial) => trial.kind },
    { title: "Conditions", cell: (trial) => conditions(trial.conditions) },
    { title: "Outcome", cell: outcome },
    { title: "Rows", number: true, cell: (trial) => number(trial.rows) },
    { title: "", cell: (trial) => withFiles(
      [h("button", { class: "small", type: "button", "aria-label": `Plot trial ${trial.trial_id}`, onclick: () => plot([trial.trial_id]) }, "Plot")],
      [["CSV", `CSV of trial ${trial.trial_id}`, `/trials/${trial.trial_id}/csv`, `trial-${trial.trial_id}.csv`],
        ["Parquet", `Parquet of trial ${trial.trial_id}`, `/trials/${trial.trial_id}/parquet`, `trial-${trial.trial_id}.parquet`]]) },
  ], shown), h("div", { class: "row centre" }, together, h("span", { class: "soft" }, `${shown.length} of ${more ? "the newest " : ""}${trials.length} trials${more ? ": choose an experiment to see older ones" : ""}`)));
}
