// Before the first question: what is needed, and the button that begins. After the last: the files, or why it was refused.

import { post } from "../app/api.js";
import { h } from "../ui/dom.js";
import { withFiles } from "../ui/files.js";
import { capital } from "../ui/format.js";
import { withShownUnit } from "../ui/units.js";

const NEEDED = [
  "The switch of the supply, where your hand can reach it.",
  "An arm that a hand can turn, bare, and free to both sides.",
  "Two weights that you know; the heavier one is the heaviest that the joint is to carry.",
];

export function beginning({ obstacle, state }, act) {
  if (obstacle) return h("p", { role: "status" }, capital(obstacle));
  const travel = h("input", { id: "travel", type: "number", min: 60, max: 360, step: "any", value: "120" });
  const name = h("input", { id: "bench-name", type: "text", maxLength: 100, autocomplete: "off", placeholder: "as now" });
  const begin = (event) => {
    event.preventDefault();
    act(event.submitter, () => post("/commission", { travel_deg: Number(travel.value), name: name.value.trim() }));
  };
  return h("form", { class: "form", onsubmit: begin },
    h("p", { class: "lead" }, "From a joint of which signs, counts, gear and gains are not known to a bench.toml that compensates: by eleven answers at most, and small motions. It takes five to nine minutes."),
    h("div", {}, h("h3", {}, "What you need"), h("ul", {}, NEEDED.map((one) => h("li", {}, one)))),
    h("label", { for: "travel" }, "How far may the arm turn to either side of straight down? [degrees]", travel),
    h("label", { for: "bench-name" }, "Name of the bench", name),
    h("div", { class: "row" }, h("button", { class: "primary" }, state === "none" ? "Begin: nothing moves yet" : "Begin anew: nothing moves yet")));
}

export function ending({ state, refusal, first_load: load }) {
  if (state === "refused") return h("div", { class: "problem", role: "alert" }, `Not commissioned: ${refusal}`);
  if (state !== "commissioned") return null;
  const found = load ? `The trial load of ${withShownUnit(load.hung_kg, "kg")} was found as ${withShownUnit(load.found_kg, "kg")}. ` : "";
  return [
    h("div", { class: "good", role: "status" }, `Commissioned. ${found}Keep both files: they are gone when the service ends. Then start the service with them: friction-bench --config bench.toml serve`),
    withFiles([], [["Download bench.toml", "Download bench.toml", "/commission/bench.toml", "bench.toml"], ["Download the evidence", "Download the evidence", "/commission/evidence.json", "bench.evidence.json"]]),
  ];
}
