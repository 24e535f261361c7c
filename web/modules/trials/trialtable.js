// One page of trials: sorted by its headings, several chosen to lay over each other, files of each.

import { h, replace, table } from "../ui/dom.js";
import { outcome, withFiles } from "../ui/files.js";
import { conditions, number } from "../ui/format.js";

// found: as GET /trials/search answers; plot(ids): one trial, or those that were chosen; turn(change): asks otherwise
export function trialTable(place, found, { asked, chosen, plot, turn, each }) {
  if (!found.items.length) {
    const looked = asked.words || asked.experiment || asked.outcome || asked.day;
    replace(place, h("p", { class: "soft" }, looked ? "No trial is like that." : "No trials yet: start an experiment on the Bench, or import a recording set."),
      looked && h("button", { type: "button", onclick: () => turn({ words: "", experiment: "", outcome: "", day: "" }) }, "Show all trials"));
    return;
  }
  const over = h("button", { type: "button", onclick: () => plot([...chosen]) });
  const count = () => {
    over.disabled = chosen.size < 2;
    over.textContent = `Lay the chosen over each other${chosen.size ? ` (${chosen.size})` : ""}`;
  };
  const box = (trial) => h("input", { type: "checkbox", checked: chosen.has(trial.trial_id), "aria-label": `Choose trial ${trial.trial_id}`, onchange: ({ target }) => {
    if (target.checked) chosen.add(trial.trial_id);
    else chosen.delete(trial.trial_id);
    count();
  } });
  const sorted = (name, text) => sortButton(name, text, asked.sort, turn);
  count();
  replace(place, table("Trials", [
    { title: "", unseen: "Choose", cell: box },
    { title: sorted("trial", "Trial"), number: true, cell: (trial) => trial.trial_id },
    { title: sorted("name", "Name"), cell: (trial) => trial.name },
    { title: sorted("kind", "Kind"), cell: (trial) => trial.kind },
    { title: "Conditions", cell: (trial) => conditions(trial.conditions) },
    { title: sorted("outcome", "Outcome"), cell: outcome },
    { title: sorted("rows", "Rows"), number: true, cell: (trial) => number(trial.rows) },
    { title: "", cell: (trial) => withFiles(
      [h("button", { class: "small", type: "button", "aria-label": `Plot trial ${trial.trial_id}`, onclick: () => plot([trial.trial_id]) }, "Plot")],
      [["CSV", `CSV of trial ${trial.trial_id}`, `/trials/${trial.trial_id}/csv`, `trial-${trial.trial_id}.csv`],
        ["Parquet", `Parquet of trial ${trial.trial_id}`, `/trials/${trial.trial_id}/parquet`, `trial-${trial.trial_id}.parquet`]]) },
  ], found.items), h("div", { class: "row centre between" }, over, pages(found, asked.page, each, turn)));
}

function pages({ total, offset, items, next_offset: next }, page, each, turn) {
  const button = (text, to, possible) => h("button", { type: "button", class: "small", disabled: !possible, onclick: () => turn({ page: to }) }, text);
  return h("div", { class: "row centre" }, h("span", { class: "soft" }, `${offset + 1} to ${offset + items.length} of ${total} trials`),
    button("First", 1, page > 1), button("Previous", page - 1, page > 1), button("Next", page + 1, next !== null), button("Last", Math.max(1, Math.ceil(total / each)), next !== null));
}

// the first press sorts upwards, the next one downwards
function sortButton(name, text, sort, turn) {
  const [up, down] = [sort === name, sort === `-${name}` || (name === "trial" && !sort)];
  const next = up ? `-${name}` : name;
  return h("button", { type: "button", class: "sort", title: `Sort by ${text.toLowerCase()}`, onclick: () => turn({ sort: next }) }, text, up ? " ▴" : down ? " ▾" : "");
}
