// Note and tags of an experiment, shown; edited in place, also of one that has ended.

import { patch } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";

export function tagsOf(text) {
  return [...new Set(text.split(",").map((one) => one.trim()).filter(Boolean))];
}

export function annotation(experiment) {
  const place = h("div", { class: "annotation" });
  show(place, experiment);
  return place;
}

function show(place, experiment) {
  const name = `Edit note and tags of experiment ${experiment.experiment_id}`;
  const edit = h("button", { class: "small", type: "button", "aria-label": name, onclick: () => change(place, experiment) }, "Edit");
  const text = experiment.note || experiment.parameters.name || "";
  replace(place, text && h("div", {}, text), experiment.tags.map((tag) => h("span", { class: "chip plain" }, tag)), edit);
  return edit;
}

function change(place, experiment) {
  const note = h("input", { value: experiment.note, maxLength: 2000, autocomplete: "off" });
  const tags = h("input", { value: experiment.tags.join(", "), autocomplete: "off", placeholder: "separated by commas" });
  const answer = h("div");
  const save = h("button", { class: "small primary" }, "Save");
  const back = (now) => show(place, now).focus(); // where the keyboard was
  const submit = async (event) => {
    event.preventDefault();
    const wanted = { note: note.value, tags: tagsOf(tags.value) };
    const changed = await attempt(answer, () => patch(`/experiments/${experiment.experiment_id}`, wanted), { button: save });
    if (changed) back(Object.assign(experiment, { note: changed.note, tags: changed.tags }));
  };
  const cancel = h("button", { class: "small", type: "button", onclick: () => back(experiment) }, "Cancel");
  replace(place, h("form", { class: "form", onsubmit: submit, novalidate: true },
    h("label", {}, "Note", note), h("label", {}, "Tags", tags), h("div", { class: "actions" }, save, cancel), answer));
  note.focus();
}
