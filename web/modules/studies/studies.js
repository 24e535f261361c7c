// Studies: the list, a new one, or the one that is open.

import { get } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { h, panel, replace, table } from "../ui/dom.js";
import { withFiles } from "../ui/files.js";
import { when } from "../ui/format.js";
import { removeButton } from "../ui/removal.js";
import { newStudy } from "./newstudy.js";
import { studyView } from "./study.js";
import { unitsForm } from "./units.js";

export function studiesView(place, { rest, query }) {
  const wanted = rest[0] === "new" ? Number(rest[1]) : null; // an experiment to make a study of
  if (rest[0] && rest[0] !== "new") return studyView(place, rest, query);
  const list = h("div");
  const create = h("div");
  replace(place, panel("Studies", h("p", { class: "soft" },
    "A study compares measured trials with a model, names the physical effect that is missing, and shows the error fall when it is added."), list),
  panel("New study", create));
  const refresh = () => attempt(list, async () => replace(list, studyTable((await get("/studies")).items, refresh)));
  const listed = refresh();
  together(place, [listed, newStudy(create, wanted)]);
  return () => {};
}

function studyTable(items, changed) {
  if (!items.length) return h("p", { class: "soft" }, "No studies yet. Choose trials below.");
  return [table("Studies", [
    { title: "Study", cell: (study) => study.study_id },
    { title: "Name", cell: (study) => h("a", { href: `#study/${study.study_id}` }, study.name) },
    { title: "Created", cell: (study) => when(study.created_utc) },
    { title: "", cell: ({ study_id: number }) => withFiles((place) => removeButton(place, { what: `study ${number}`, path: `/studies/${number}`, done: changed, loses: "with its models, but not its trials" }), []) },
  ], items), items.length > 1 && h("p", {}, h("a", { href: `#compare/${items[1].study_id}./${items[0].study_id}.` }, "Two studies beside each other")),
  items.length > 2 && unitsForm(items)];
}
