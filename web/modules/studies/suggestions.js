// Which trials would separate the rivals of a diagnosis: ask, queue them or start one, and add them to the study; or
// round by round, a few at a time.

import { post } from "../app/api.js";
import { attempt, patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { nameOf, number, quantity, spoken } from "../ui/format.js";

// model_id(): the model that is shown; extended(sentence): the study has more trials now
export function suggestions(place, path, model_id, extended) {
  const answer = h("div");
  const button = h("button", { type: "button" }, "Suggest trials");
  button.addEventListener("click", async () => {
    const found = await patiently(answer, "suggest", "Simulating what each trial would tell …", (signal, job) => post(`${path}/suggest`, { model_id: model_id() }, 0, { signal, job }), { button });
    if (found) show(answer, path, found, extended);
  });
  const round = h("button", { type: "button", title: "The joint moves when it is the queue's turn" }, "Record the next round");
  round.addEventListener("click", async () => {
    const made = await patiently(answer, "round", "Adding what was recorded, diagnosing, and simulating what each trial would tell …", (signal, job) => post(`${path}/rounds`, {}, 0, { signal, job }), { button: round });
    if (!made) return;
    const told = `${spoken(made.suggested.diagnosis)} ${spoken(made.suggested.sentence)} ${queued(made.item_ids.length)}`;
    if (made.extended) await extended(`${made.extended.sentence} ${told}`);
    else replace(answer, h("div", { class: "good", role: "status" }, told), ...keptOut(made.suggested));
  });
  replace(place, h("div", { class: "row centre" }, button, round, h("span", { class: "soft" }, "which trials would tell apart what these cannot")), answer);
}

function queued(count) {
  return count ? `${count} in the queue. When they have ended, record the next round.` : "Nothing is queued.";
}

function keptOut(found) {
  return found.kept_out.map((one) => h("p", { class: "soft" }, `Kept out: ${one.kind}, experiment ${one.experiment_id}, ${one.outcome}: ${one.reason}`));
}

function show(place, path, found, extended) {
  const [started, added] = [h("div"), h("div")];
  const start = (one) => async ({ currentTarget: button }) => {
    const made = await attempt(started, () => post("/experiments", { kind: one.kind, parameters: one.parameters, note: found.note }), { button });
    if (made) replace(started, h("div", { class: "good", role: "status" }, `Experiment ${made.experiment_id} has started. When it has ended, start the next, or add what was recorded.`));
  };
  const items = found.trials.map(({ kind, parameters }) => ({ kind, parameters, note: found.note }));
  const queue = h("button", { type: "button", class: "primary", onclick: async ({ currentTarget: button }) => {
    const queued = await attempt(started, () => post("/queue", { items }), { button });
    if (queued) replace(started, h("div", { class: "good", role: "status" }, `${queued.item_ids.length} in the queue. When they have ended, add what was recorded.`));
  } }, "Queue all of them");
  const add = h("button", { type: "button", onclick: async ({ currentTarget: button }) => {
    const result = await patiently(added, "fit", "Fitting …", (signal, job) => post(`${path}/trials`, {}, 0, { signal, job }), { button });
    if (result) await extended(result.sentence);
  } }, "Add the recorded trials to the study");
  replace(place, h("p", { class: "sentence", role: "status" }, spoken(found.sentence)), found.trials.length > 0 && table("Suggested trials", [
    { title: "Trial", cell: (one) => [one.kind, h("div", { class: "hint" }, words(one.parameters))] },
    { title: "Minutes", number: true, cell: (one) => number(one.minutes, 2) },
    { title: "Why", cell: (one) => spoken(one.sentence) },
    { title: "", cell: (one) => h("button", { type: "button", class: "small", "aria-label": `Start ${one.kind}: ${words(one.parameters)}`, onclick: start(one) }, "Start") },
  ], found.trials), found.trials.length > 0 && h("div", { class: "row" }, queue, add), ...keptOut(found), started, added);
}

function words(parameters) {
  return Object.entries(parameters).map(([name, value]) => `${nameOf(name)} ${[value].flat().map((one) => quantity(name, one)).join(", ")}`).join("; ");
}
