// The search: the lab adds, exchanges and drops effects by itself; every step is told.

import { post } from "../app/api.js";
import { patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { percent, spoken } from "../ui/format.js";

// done(model_id): the search ended at this model
export function searchButton(place, path, model_id, done) {
  const answer = h("div");
  const button = h("button", { type: "button" }, "Search by itself");
  button.addEventListener("click", async () => {
    const found = await patiently(answer, "search", "Adding effects until nothing is missing …", (signal, job) => post(`${path}/search`, { model_id: model_id() }, 0, { signal, job }), { button });
    if (!found) return;
    await done(found.model_id, (target) => told(target, found));
  });
  replace(place, h("div", { class: "row centre" }, button, h("span", { class: "soft" }, "adds, exchanges and drops effects until nothing is missing; every model on the way is kept")), answer);
}

function told(place, found) {
  replace(place, h("div", { class: "good", role: "status" }, found.steps.length ? `${found.steps.length} steps. ${spoken(found.sentence)}` : spoken(found.sentence)),
    found.findings.map(({ text }) => h("p", { class: "soft" }, text)),
    found.steps.length > 0 && table("Steps of the search", [
      { title: "Step", cell: (step) => spoken(step.sentence) },
      { title: "Held-out before", number: true, cell: (step) => percent(step.before) },
      { title: "after", number: true, cell: (step) => percent(step.after) },
    ], found.steps));
}
