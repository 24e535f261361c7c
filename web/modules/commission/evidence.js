// What was found so far: each value with its 95 % interval, and from what it was told.

import { h, table } from "../ui/dom.js";
import { number, spoken } from "../ui/format.js";

export function evidenceTable(evidence) {
  if (!evidence.length) return null;
  return table("Found so far, with uncertainty", [
    { title: "What", cell: (one) => one.name },
    { title: "Value", number: true, cell: (one) => (typeof one.value === "number" ? `${number(one.value)} ${one.unit}`.trim() : "") },
    { title: "95 %", number: true, cell: (one) => (one.low === null || one.high === null ? "" : `${number(one.low)} to ${number(one.high)}`) },
    { title: "From", cell: (one) => [typeof one.value === "string" && h("div", {}, spoken(one.value)), h("span", { class: "hint" }, spoken(one.how)),
      one.experiment_id && [" ", h("a", { href: `#trials?experiment=${one.experiment_id}` }, `experiment ${one.experiment_id}`)]] },
  ], [...evidence].reverse());
}
