// Buttons that hand over files, and how something ended; problems of the buttons appear beneath them.

import { download } from "../app/api.js";
import { attempt, patiently } from "./attempt.js";
import { h } from "./dom.js";

// buttons, or what makes them of the place of their answers. files: [text, label, path, name, what], the last for one that is computed first: it says how far it has come
export function withFiles(buttons, files) {
  const answer = h("div");
  return [h("div", { class: "actions" }, typeof buttons === "function" ? buttons(answer) : buttons, files.map((file) => fileButton(...file))), answer];
}

export function outcome(one) {
  return [h("span", { class: `badge ${one.outcome}` }, one.outcome), one.reason && h("div", { class: "hint" }, one.reason)].filter(Boolean);
}

function fileButton(text, label, path, name, what = null) {
  const fetchFile = ({ currentTarget: button }) => {
    const answer = button.parentElement.nextElementSibling;
    if (what) patiently(answer, what, `${label} …`, (signal, job) => download(path, name, { signal, job }), { button });
    else attempt(answer, () => download(path, name), { button });
  };
  return h("button", { class: "small", type: "button", "aria-label": label, onclick: fetchFile }, text);
}
