// Starting an experiment: choose a kind, fill in the form that its schema gives, start.

import { get, post } from "./api.js";
import { h, replace } from "./dom.js";
import { Form } from "./form.js";
import { attempt, problemBox } from "./problem.js";

export async function startForm(place, live) {
  const kinds = await attempt(place, async () => (await get("/experiment-kinds")).items);
  if (!kinds) return;
  const choice = h("select", { id: "kind" }, kinds.map((kind) => h("option", { value: kind.name }, kind.title)));
  const summary = h("p", { class: "soft" });
  const parameters = h("div");
  const operator = h("input", { id: "operator", autocomplete: "name" });
  const note = h("input", { id: "note", autocomplete: "off" });
  const pace = h("input", { type: "checkbox", id: "fast" });
  const button = h("button", { class: "primary" }, "Start");
  const answer = h("div");
  let form;

  const choose = () => {
    const kind = kinds.find((one) => one.name === choice.value);
    form = new Form(kind.parameters, "parameter");
    summary.textContent = kind.summary;
    replace(parameters, form.element);
  };
  const submit = async (event) => {
    event.preventDefault();
    form.showProblems([], "parameters");
    const body = { kind: choice.value, parameters: form.values(), operator: operator.value, note: note.value };
    if (live.status?.simulated) body.pace = pace.checked ? "fast" : "real-time";
    const started = await attempt(answer, () => send(body, form, answer), { button });
    if (started) replace(answer, h("div", { class: "good", role: "status" }, `Experiment ${started.experiment_id} has started.`));
  };
  choice.addEventListener("change", choose);
  choose();
  replace(place, h("form", { class: "form", onsubmit: submit, novalidate: true },
    h("label", { for: "kind" }, "What to do", choice), summary, parameters,
    h("details", {}, h("summary", {}, "Operator, note, pace"),
      h("div", { class: "form" },
        h("label", { for: "operator" }, "Operator", operator), h("label", { for: "note" }, "Note", note),
        h("label", { class: "inline" }, pace, "as fast as the computer can (simulated drive only)"))),
    h("div", { class: "row" }, button), answer));
}

async function send(body, form, answer) {
  try {
    return await post("/experiments", body);
  } catch (error) {
    const elsewhere = error.errors ? form.showProblems(error.errors, "parameters") : [];
    if (error.errors?.length && !elsewhere.length) {
      replace(answer, problemBox(new Error("Not started, nothing has moved. See the marked fields.")));
      return undefined;
    }
    throw error;
  }
}
