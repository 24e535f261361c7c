// A new study: which experiments, and which conditions are held out of the fit.

import { get, post } from "./api.js";
import { h, replace } from "./dom.js";
import { nameOf, number, unitOf, when } from "./format.js";
import { attempt } from "./problem.js";

export async function newStudy(place, wanted = null) {
  const experiments = await attempt(place, async () => (await get("/experiments", { limit: 100 })).items);
  if (!experiments) return;
  const usable = experiments.filter((one) => one.outcome !== "refused" && one.outcome !== "running");
  if (!usable.length) {
    replace(place, h("p", { class: "soft" }, "There are no trials yet: start an experiment on the Bench, or import a recording set under Trials."));
    return;
  }
  const name = h("input", { id: "study-name", required: true, value: `study ${new Date().toLocaleDateString()}` });
  const boxes = usable.map((one) => h("input", { type: "checkbox", value: String(one.experiment_id), checked: one.experiment_id === wanted }));
  const holdOut = h("div");
  const answer = h("div");
  const button = h("button", { class: "primary" }, "Create study");
  const chosen = () => boxes.filter((box) => box.checked).map((box) => Number(box.value));
  const change = () => attempt(holdOut, async () => replace(holdOut, await holdOutFields(chosen())));
  for (const box of boxes) box.addEventListener("change", change);
  const submit = async (event) => {
    event.preventDefault();
    const hold_out = [...holdOut.querySelectorAll("input:checked")].map((box) => box.value);
    const body = { name: name.value, experiment_ids: chosen(), hold_out };
    const study = await attempt(answer, () => post("/studies", body), { button, busy: "Fitting the base model …" });
    if (study) location.hash = `#study/${study.study_id}`;
  };
  const choices = usable.map((one, index) => h("label", { class: "inline" }, boxes[index],
    `${one.experiment_id}: ${one.kind}, ${one.source}, ${one.outcome}, ${when(one.started_utc)}${noteOf(one)}`));
  replace(place, h("form", { class: "form", onsubmit: submit }, h("label", { for: "study-name" }, "Name", name),
    h("fieldset", {}, h("legend", {}, "Experiments whose trials are used"), choices), holdOut, h("div", { class: "row" }, button), answer));
  if (chosen().length) {
    change();
    place.scrollIntoView({ block: "start" });
  }
}

function noteOf(experiment) {
  const note = experiment.note || experiment.parameters.name;
  return note ? ` (${note})` : "";
}

async function holdOutFields(experiment_ids) {
  if (!experiment_ids.length) return null;
  const pages = await Promise.all(experiment_ids.map((experiment_id) => get("/trials", { experiment_id, limit: 500 })));
  const trials = pages.flatMap((page) => page.items);
  const keys = [...new Set(trials.flatMap((trial) => Object.keys(trial.conditions)))];
  const groups = keys.map((key) => [key, [...new Set(trials.map((trial) => trial.conditions[key]).filter((value) => value !== undefined))]])
    .filter(([, values]) => values.length > 1 && values.length <= 60);
  if (trials.length <= 60) groups.push(["trial", trials.map((trial) => trial.name)]);
  if (!groups.length) return h("p", { class: "soft" }, "One trial only: nothing can be held out.");
  return h("fieldset", {}, h("legend", {}, "Held out of the fit, to judge it (by condition; none: each trial is left out in turn)"),
    groups.map(([key, values]) => h("details", { open: key !== "trial" && values.length <= 12 },
      h("summary", {}, nameOf(key)), h("div", { class: "row centre" }, values.map((value) => holdOutBox(key, value))))));
}

function holdOutBox(key, value) {
  const unit = typeof value === "number" ? unitOf(key) : "";
  return h("label", { class: "inline" }, h("input", { type: "checkbox", value: `${key}=${value}` }), `${number(value)}${unit ? ` ${unit}` : ""}`);
}