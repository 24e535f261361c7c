// Starting an experiment: choose a kind, fill in the form that its schema gives, start.

import { get, post } from "../app/api.js";
import { attempt, problemBox } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";
import { Form } from "../ui/form.js";

// queued(): something was put into the queue
export async function startForm(place, live, queued) {
  const kinds = await attempt(place, async () => (await get("/experiment-kinds")).items);
  if (!kinds) return;
  const choice = h("select", { id: "kind" }, kinds.map((kind) => h("option", { value: kind.name }, kind.title)));
  const summary = h("p", { class: "soft" });
  const parameters = h("div");
  const operator = h("input", { id: "operator", autocomplete: "name" });
  const note = h("input", { id: "note", autocomplete: "off" });
  const pace = h("input", { type: "checkbox", id: "fast" });
  const tags = h("input", { id: "tags", autocomplete: "off", placeholder: "separated by commas" });
  const button = h("button", { class: "primary" }, "Start");
  const later = h("button", { type: "button" }, "Queue");
  const answer = h("div");
  let form;

  const choose = () => {
    const kind = kinds.find((one) => one.name === choice.value);
    form = new Form(kind.parameters, "parameter");
    summary.textContent = kind.summary;
    replace(parameters, form.element);
  };
  const wanted = () => {
    form.showProblems([], "parameters");
    const body = { kind: choice.value, parameters: form.values(), operator: operator.value, note: note.value };
    if (live.status?.simulated) body.pace = pace.checked ? "fast" : "real-time";
    return { ...body, tags: tags.value.split(",").map((one) => one.trim()).filter(Boolean) };
  };
  later.addEventListener("click", async () => {
    const added = await attempt(answer, () => send("/queue", { items: [wanted()] }, form, answer), { button: later });
    if (!added) return;
    replace(answer, h("div", { class: "good", role: "status" }, "It is in the queue; it starts when it is its turn."));
    queued();
  });
  const submit = async (event) => {
    event.preventDefault();
    const started = await attempt(answer, () => send("/experiments", wanted(), form, answer), { button });
    if (started) replace(answer, h("div", { class: "good", role: "status" }, `Experiment ${started.experiment_id} has started.`));
  };
  choice.addEventListener("change", choose);
  choose();
  replace(place, h("form", { class: "form", onsubmit: submit, novalidate: true },
    h("label", { for: "kind" }, "What to do", choice), summary, parameters,
    h("details", {}, h("summary", {}, "Operator, note, tags, pace"),
      h("div", { class: "form" },
        h("label", { for: "operator" }, "Operator", operator), h("label", { for: "note" }, "Note", note), h("label", { for: "tags" }, "Tags", tags),
        h("label", { class: "inline" }, pace, "as fast as the computer can (simulated drive only)"))),
    h("div", { class: "row" }, button, later), answer));
}

async function send(path, body, form, answer) {
  try {
    return await post(path, body);
  } catch (error) {
    const elsewhere = error.errors ? form.showProblems(error.errors, "parameters") : [];
    if (error.errors?.length && !elsewhere.length) {
      replace(answer, problemBox(new Error("Not started, nothing has moved. See the marked fields.")));
      return undefined;
    }
    throw error;
  }
}
