// The moments behind a bad spot: each leads to its place in the trial.

import { h, replace, table } from "./dom.js";
import { number } from "./format.js";

// show(moment): look at it in time
export function momentList(place, words, found, show) {
  const unit = found.effort.unit;
  replace(place, h("h3", {}, `Moments at ${words}`), found.items.length
    ? table("Moments", [
      { title: "Trial", cell: (one) => one.name },
      { title: "From [s]", number: true, cell: (one) => one.from_s.toFixed(2) },
      { title: "To [s]", number: true, cell: (one) => one.to_s.toFixed(2) },
      { title: `rms [${unit}]`, number: true, cell: (one) => number(one.rms, 3) },
      { title: `mean [${unit}]`, number: true, cell: (one) => number(one.mean, 3) },
      { title: "", cell: (one) => h("button", { type: "button", class: "small", "aria-label": `Show ${one.name} at ${one.from_s.toFixed(2)} s`, onclick: () => show(one) }, "Show") },
    ], found.items)
    : h("p", { class: "soft" }, "No row lies there."));
}
