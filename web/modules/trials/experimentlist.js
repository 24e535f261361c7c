// What has been run, newest first: by tag, page by page; files of each.

import { annotation } from "./annotation.js";
import { get } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { outcome, withFiles } from "../ui/files.js";
import { when } from "../ui/format.js";
import { removeButton } from "../ui/removal.js";

const EACH = 10;
const NOTHING = "Nothing has been run yet. Start an experiment on the Bench, or import a recording set.";

// choose(experiment_id); returns {refresh}, which resolves to the newest page
export function experimentList(place, choose) {
  const list = h("div");
  let [tag, offset] = ["", 0];
  const turn = (to) => {
    offset = to;
    return refresh();
  };
  const refresh = () => attempt(list, async () => {
    const page = await get("/experiments", { tag, offset, limit: EACH });
    const nothing = tag ? `No experiment has the tag '${tag}'.` : NOTHING;
    replace(list, page.items.length ? experimentTable(page.items, choose, refresh) : h("p", { class: "soft" }, nothing), pager(page, turn));
    return page.items;
  });
  const wanted = h("input", { type: "search", placeholder: "all", onchange: ({ target }) => {
    tag = target.value.trim();
    turn(0);
  } });
  replace(place, h("div", { class: "row" }, h("label", {}, "Tag", wanted)), h("div", { class: "gap" }), list);
  return { refresh };
}

function pager(page, turn) {
  if (page.offset === 0 && page.next_offset === null) return null;
  const button = (text, to) => h("button", { class: "small", type: "button", disabled: to === null, onclick: () => turn(to) }, text);
  const newer = page.offset ? Math.max(0, page.offset - page.limit) : null;
  return h("div", { class: "actions" }, button("Newer", newer), button("Older", page.next_offset));
}

function experimentTable(items, choose, changed) {
  const removal = ({ experiment_id: number }, place) => removeButton(place, { what: `experiment ${number}`, loses: "with its trials and all that was recorded in them",
    path: `/experiments/${number}`, done: changed });
  return table("Experiments", [
    { title: "Experiment", number: true, cell: (one) => one.experiment_id },
    { title: "Kind", cell: (one) => one.kind },
    { title: "Source", cell: (one) => h("span", { class: `badge ${one.source}` }, one.source) },
    { title: "Started", cell: (one) => when(one.started_utc) },
    { title: "Outcome", cell: (one) => outcome(one) },
    { title: "Note and tags", cell: annotation },
    { title: "", cell: (one) => withFiles(
      (place) => [h("button", { class: "small", type: "button", "aria-label": `Trials of experiment ${one.experiment_id}`, onclick: () => choose(one.experiment_id) }, "Trials"), removal(one, place)],
      [["Export", `Recording set of experiment ${one.experiment_id}`, `/experiments/${one.experiment_id}/recording-set`, `experiment-${one.experiment_id}.zip`],
        ["Parquet", `Parquet of experiment ${one.experiment_id}`, `/experiments/${one.experiment_id}/parquet`, `experiment-${one.experiment_id}.parquet`]]) },
  ], items);
}
