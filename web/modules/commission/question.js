// One question: a number with its unit and what is allowed, or something to be done.

import { h, replace } from "../ui/dom.js";
import { problemOf } from "../ui/form.js";
import { number } from "../ui/format.js";

const MEASURED_ANEW = "hand_angle_deg";
const given = new Map(); // what was typed: whoever has to begin anew need not type it again

// send(button, value): value null where it is done, or not known
export function questionForm(asked, send) {
  if (!asked.wants_value) {
    return h("div", { class: "question", "data-question": asked.key }, h("p", { class: "sentence", role: "status" }, asked.sentence),
      h("div", { class: "row" }, h("button", { type: "button", class: "primary", onclick: ({ currentTarget }) => send(currentTarget, null) }, "Done")));
  }
  const input = h("input", { id: "answer", type: "text", inputMode: "decimal", autocomplete: "off", value: asked.key === MEASURED_ANEW ? "" : given.get(asked.key) ?? "", "aria-describedby": "answer-hint answer-problem" });
  const problem = h("div", { id: "answer-problem" });
  const button = h("button", { class: "primary" }, "Answer");
  const kind = { type: "number", minimum: asked.least, maximum: asked.most, shown: { unit: asked.unit, factor: 1 } };
  const submit = (event) => {
    event.preventDefault();
    const text = input.value.trim().replace(",", ".");
    const value = text === "" ? undefined : Number.isFinite(Number(text)) ? Number(text) : text;
    const message = problemOf(kind, value);
    input.setAttribute("aria-invalid", String(Boolean(message)));
    replace(problem, message && h("div", { class: "problem field-problem", role: "alert" }, message));
    if (message) return;
    given.set(asked.key, text);
    send(button, value);
  };
  const unit = asked.unit ? ` [${asked.unit}]` : "";
  return h("form", { class: "question form", "data-question": asked.key, onsubmit: submit, novalidate: true },
    h("label", { for: "answer", class: "sentence" }, `${asked.sentence}${unit}`, input),
    h("div", { class: "hint", id: "answer-hint" }, `${number(asked.least)} to ${number(asked.most)} ${asked.unit}`.trim()), problem,
    h("div", { class: "row" }, button, asked.optional && h("button", { type: "button", onclick: ({ currentTarget }) => send(currentTarget, null) }, "Not known")));
}
