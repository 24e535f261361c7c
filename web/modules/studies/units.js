// Units of one kind: a study for each, all fitted with the first one's model; what they share, and which is an outlier.

import { get } from "../app/api.js";
import { patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { chanceCell, interval, number, percent, spoken } from "../ui/format.js";
import { unitText, writerOf } from "./parameters.js";

const FEWEST = 3;

export function unitsForm(studies) {
  const boxes = studies.map(({ study_id: value }) => h("input", { type: "checkbox", value: String(value) }));
  const labels = studies.map(({ study_id: value, name }, index) => h("label", { class: "inline" }, boxes[index], `${value}: ${name}`));
  const [answer, button] = [h("div"), h("button", { type: "button" }, "Compare units")];
  button.addEventListener("click", async () => {
    const [first, ...beside] = boxes.filter((box) => box.checked).map((box) => Number(box.value)).sort((a, b) => a - b);
    if (beside.length + 1 < FEWEST) {
      replace(answer, h("p", { class: "soft", role: "status" }, `Choose at least ${FEWEST}.`));
      return;
    }
    const path = `/studies/${first}/units?${beside.map((one) => `beside=${one}`).join("&")}`;
    const found = await patiently(answer, "units", "Fitting every unit …", (signal, job) => get(path, {}, { signal, job }), { button });
    if (found) replace(answer, unitTables(found));
  });
  return h("details", {}, h("summary", {}, "Units of one kind"),
    h("p", { class: "soft" }, "A study for each unit; all are fitted with the model of the first that is chosen."),
    h("div", { class: "choices" }, labels), h("div", { class: "row" }, button), answer);
}

function unitTables({ parameters, sentence, notes, units }) {
  const rows = parameters.flatMap((one) => one.values.map((value) => ({ one, value, chosen: value.outlier })));
  const odd = rows.some(({ chosen }) => chosen);
  return [h("div", { class: odd ? "problem" : "good", role: "status" }, spoken(sentence)),
    table("What units have in common", [
      { title: "Parameter", cell: (one) => spoken(one.name) },
      { title: "Mean (95 %)", number: true, cell: (one) => within(one.mean, one.mean_low, one.mean_high) },
      { title: "Scatter between units (95 %)", number: true, cell: (one) => within(one.scatter, one.scatter_low, one.scatter_high) },
      { title: "One more unit", number: true, cell: (one) => `${number(one.next_low, 3)} to ${number(one.next_high, 3)}` },
      { title: "Unit", cell: (one) => unitText(one.unit) },
      { title: "Units differ", cell: (one) => (one.differs ? "yes" : "not shown") },
      { title: "p", number: true, cell: (one) => chanceCell(one.p_value) },
    ], parameters),
    table("Each unit beside the others", [
      { title: "Parameter", cell: ({ one }) => spoken(one.name) },
      { title: "Study", cell: ({ value }) => h("a", { href: `#study/${value.study_id}` }, value.name) },
      { title: "Value (95 %)", number: true, cell: ({ value }) => within(value.value, value.low, value.high) },
      { title: "Expected", number: true, cell: ({ value }) => `${number(value.expected_low, 3)} to ${number(value.expected_high, 3)}` },
      { title: "Off by (95 %)", number: true, cell: ({ value }) => within(value.deviation, value.deviation_low, value.deviation_high) },
      { title: "p", number: true, cell: ({ value }) => chanceCell(value.p_value) },
      { title: "", unseen: "Outlier", cell: ({ value }) => (value.outlier ? "outlier" : "") },
    ], rows),
    table("Units", [
      { title: "Study", cell: (unit) => unit.name },
      { title: "Trials", number: true, cell: (unit) => unit.trials },
      { title: "Error", number: true, cell: (unit) => percent(unit.error) },
    ], units),
    notes.map((note) => h("p", { class: "soft" }, spoken(note)))];
}

function within(value, low, high) {
  return interval(value, low, high, writerOf({ low, high }));
}
