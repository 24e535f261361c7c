// A new study: which experiments, which of their trials, and which conditions are held out of the fit.

import { get, post, token } from "../app/api.js";
import { attempt, patiently, problemBox } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";
import { capital, nameOf, quantity, when } from "../ui/format.js";
import { heldOut, TrialChoice, used } from "./trialchoice.js";

const MOST = 500;
const LISTED = 20; // experiments that are offered at once; the others are found by their words
const CHECK_AFTER_MS = 400;

export async function newStudy(place, wanted = null) {
  const experiments = await attempt(place, async () => (await get("/experiments", { limit: MOST })).items);
  if (!experiments) return;
  const usable = experiments.filter((one) => one.outcome !== "refused" && one.outcome !== "running");
  if (!usable.length) {
    replace(place, h("p", { class: "soft" }, "There are no trials yet: start an experiment on the Bench, or import a recording set under Trials."));
    return;
  }
  const name = h("input", { id: "study-name", required: true, value: `study ${when(new Date()).slice(0, 10)}` });
  const boxes = usable.map((one) => h("input", { type: "checkbox", value: String(one.experiment_id), checked: one.experiment_id === wanted }));
  const labels = usable.map((one, index) => h("label", { class: "inline" }, boxes[index], words(one)));
  const find = h("input", { type: "search", id: "study-find", placeholder: "kind, tag, note, outcome …", oninput: () => {
    const asked = find.value.toLowerCase().split(/\s+/);
    // what is chosen stays in sight: it would be used
    show(asked);
  } });
  const list = h("div", { class: "choices" });
  const show = (asked) => {
    const found = labels.filter((label, index) => boxes[index].checked || asked.every((word) => label.textContent.toLowerCase().includes(word)));
    replace(list, found.slice(0, LISTED), found.length > LISTED && h("p", { class: "soft" }, `${found.length - LISTED} more: find them by their words.`));
  };
  show([]);
  const [choice, carries, answer] = [h("div", { class: "form" }), h("div"), h("div")];
  let timer = null;
  const [using, holding] = [new TrialChoice(used), new TrialChoice(heldOut)];
  const button = h("button", { class: "primary", id: "study-create" }, "Create study");
  const chosen = () => boxes.filter((box) => box.checked).map((box) => Number(box.value));
  const change = () => attempt(choice, async () => {
    const trials = await trialsOf(chosen());
    using.show(trials);
    holding.show(trials);
    replace(choice, using.element, holding.element);
    checkSoon();
  });
  // whether these trials can carry a model is said before one is made of them
  const check = async () => {
    const body = { experiment_ids: chosen(), where: using.unlessAll(), hold_out: holding.chosen() };
    if (!body.experiment_ids.length || !token.get()) {
      replace(carries);
      return;
    }
    const found = await post("/studies/check", body).catch((error) => ({ problem: error }));
    if (found.problem?.status === 401) return;
    button.textContent = found.carries ? "Create study" : "Create study all the same";
    button.className = found.carries ? "primary" : "";
    replace(carries, found.problem ? problemBox(found.problem) : h("div", { class: found.carries ? "good" : "problem", role: "status" }, found.sentence),
      !found.problem && h("p", { class: "soft" }, found.hold_out ? `Worth holding out: ${criterion(found.hold_out)} (${found.advice}).` : `${capital(found.advice)}.`));
  };
  const checkSoon = () => {
    clearTimeout(timer);
    timer = setTimeout(check, CHECK_AFTER_MS);
  };
  choice.addEventListener("change", checkSoon);
  for (const box of boxes) box.addEventListener("change", change);
  const submit = async (event) => {
    event.preventDefault();
    const body = { name: name.value, experiment_ids: chosen(), where: using.unlessAll(), hold_out: holding.chosen() };
    const study = await patiently(answer, "new study", "Fitting the base model …", (signal, job) => post("/studies", body, 0, { signal, job }), { button, again: () => button.click() });
    if (study) location.hash = `#study/${study.study_id}`;
  };
  replace(place, h("form", { class: "form", onsubmit: submit }, h("label", { for: "study-name" }, "Name", name),
    h("fieldset", {}, h("legend", {}, "Experiments whose trials are used"), usable.length > 5 && h("label", { for: "study-find" }, "Find experiments", find),
      list), choice, carries, h("div", { class: "row" }, button), answer));
  if (chosen().length) {
    change();
    place.scrollIntoView({ block: "start" });
  }
}

// "load_kg=0.05" -> "load 50 g"
function criterion(text) {
  const [key, value] = text.split("=");
  return `${nameOf(key)} ${Number.isFinite(Number(value)) ? quantity(key, Number(value)) : value}`;
}

function words(one) {
  const note = one.note || one.parameters.name;
  const tags = one.tags?.length ? `, ${one.tags.join(", ")}` : "";
  return `${one.experiment_id}: ${one.kind}, ${one.source}, ${one.outcome}, ${when(one.started_utc)}${tags}${note ? ` (${note})` : ""}`;
}

async function trialsOf(experiment_ids) {
  const pages = await Promise.all(experiment_ids.map((experiment_id) => get("/trials", { experiment_id, limit: MOST })));
  return pages.flatMap((page) => page.items);
}
