// What was filled in or looked for, kept under a name in this browser: an address, which shows it again.

import { h, replace } from "./dom.js";

const KEY = "friction-bench-presets";
const all = () => JSON.parse(localStorage.getItem(KEY) ?? "{}");

// view: whose presets; hash(): the address of what is there now; open(hash): shows it
export function presets(place, view, hash, open) {
  const kept = () => all()[view] ?? {};
  const keep = (changed) => {
    localStorage.setItem(KEY, JSON.stringify({ ...all(), [view]: changed }));
    show();
  };
  const show = (chosen = "") => {
    const names = Object.keys(kept()).sort();
    const choice = h("select", { id: `${view}-preset`, onchange: () => {
      if (!choice.value) return;
      open(kept()[choice.value]);
      show(choice.value);
    } }, h("option", { value: "" }, names.length ? "– choose –" : "– none yet –"), names.map((name) => h("option", { value: name, selected: name === chosen }, name)));
    const name = h("input", { id: `${view}-preset-name`, maxLength: 60, autocomplete: "off", "aria-label": "Name of the preset", placeholder: "name" });
    const save = () => {
      const called = name.value.trim();
      if (called) keep({ ...kept(), [called]: hash() });
      else name.focus();
    };
    const forget = () => keep(Object.fromEntries(Object.entries(kept()).filter(([each]) => each !== chosen)));
    replace(place, h("details", { open: place.querySelector("details")?.open }, h("summary", {}, "Presets"), h("div", { class: "row presets" }, h("label", { for: choice.id }, "Preset", choice), name, h("button", { type: "button", class: "small", onclick: save }, "Save as preset"),
      chosen && h("button", { type: "button", class: "small", onclick: forget }, `Remove '${chosen}'`))));
  };
  show();
}
