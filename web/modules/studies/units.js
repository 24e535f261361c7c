// Units of one kind: a study for each, all fitted with the first one's model; what they share,
// and which is an outlier; of two, what differs.

import { get } from "../app/api.js";
import { patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { chanceCell, interval, number, percent, spoken } from "../ui/format.js";
import { unitText, writerOf } from "./parameters.js";

const FEWEST = 2;

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

function unitTables({ differences, parameters, sentence, notes, units }) {
  const odd = parameters.some((one) => one.values.some((value) => value.outlier));
  const judged = odd ? "problem" : "good";
  return [h("div", { class: differences.length ? "soft" : judged, role: "status" }, spoken(sentence)),
    differences.length ? tableOfTwo(differences, units) : tablesOfMany(parameters),
    headed("Units", [
      { title: "Study", cell: (unit) => unit.name },
      { title: "Trials", number: true, cell: (unit) => unit.trials },
      { title: "Error", number: true, cell: (unit) => percent(unit.error) },
    ], units),
    notes.map((note) => h("p", { class: "soft" }, spoken(note)))];
}

function headed(title, columns, rows) {
  return [h("h3", {}, title), table(title, columns, rows)];
}

function tableOfTwo(differences, [first, second]) {
  const rows = differences.map((one) => ({ ...one, chosen: one.low > 0 || one.high < 0 }));
  return headed("What differs between the two units", [
    { title: "Parameter", cell: (one) => spoken(one.name) },
    { title: `${first.study_id}: ${first.name}`, number: true, cell: (one) => number(one.first, 3) },
    { title: `${second.study_id}: ${second.name}`, number: true, cell: (one) => number(one.second, 3) },
    { title: "Difference (90 %)", number: true, cell: (one) => within(one.difference, one.low, one.high) },
    { title: "Unit", cell: (one) => unitText(one.unit) },
  ], rows);
}

function tablesOfMany(parameters) {
  const rows = parameters.flatMap((one) => one.values.map((value) => ({ one, value, chosen: value.outlier })));
  return [
    headed("What units have in common", [
      { title: "Parameter", cell: (one) => spoken(one.name) },
      { title: "Mean (95 %)", number: true, cell: (one) => within(one.mean, one.mean_low, one.mean_high) },
      { title: "Scatter between units (95 %)", number: true, cell: (one) => within(one.scatter, one.scatter_low, one.scatter_high) },
      { title: "One more unit", number: true, cell: (one) => `${number(one.next_low, 3)} to ${number(one.next_high, 3)}` },
      { title: "Unit", cell: (one) => unitText(one.unit) },
      { title: "Units differ", cell: (one) => (one.differs ? "yes" : "not shown") },
      { title: "p", number: true, cell: (one) => chanceCell(one.p_value) },
    ], parameters),
    headed("Each unit beside the others", [
      { title: "Parameter", cell: ({ one }) => spoken(one.name) },
      { title: "Study", cell: ({ value }) => h("a", { href: `#study/${value.study_id}` }, value.name) },
      { title: "Value (95 %)", number: true, cell: ({ value }) => within(value.value, value.low, value.high) },
      { title: "Expected", number: true, cell: ({ value }) => `${number(value.expected_low, 3)} to ${number(value.expected_high, 3)}` },
      { title: "Off by (95 %)", number: true, cell: ({ value }) => within(value.deviation, value.deviation_low, value.deviation_high) },
      { title: "p", number: true, cell: ({ value }) => chanceCell(value.p_value) },
      { title: "", unseen: "Outlier", cell: ({ value }) => (value.outlier ? "outlier" : "") },
    ], rows)];
}

function within(value, low, high) {
  return interval(value, low, high, writerOf({ low, high }));
}
