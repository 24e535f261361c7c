// Buttons that hand over files, and how something ended; problems of the buttons appear beneath them.

import { download } from "../app/api.js";
import { attempt } from "./attempt.js";
import { h } from "./dom.js";

// files: [text, label, path, name]
export function withFiles(buttons, files) {
  return [h("div", { class: "actions" }, buttons, files.map((file) => fileButton(...file))), h("div")];
}

export function outcome(one) {
  return [h("span", { class: `badge ${one.outcome}` }, one.outcome), one.reason && h("div", { class: "hint" }, one.reason)].filter(Boolean);
}

function fileButton(text, label, path, name) {
  const fetchFile = ({ currentTarget: button }) => attempt(button.parentElement.nextElementSibling, () => download(path, name), { button });
  return h("button", { class: "small", type: "button", "aria-label": label, onclick: fetchFile }, text);
}
