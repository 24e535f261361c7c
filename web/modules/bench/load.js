// The friction-compensated current, what a master arm is given, with its 95 % band.
// The load that each trial of the experiment found, with its 95 % interval, beside the load that hung there.

import { h, replace, table } from "../ui/dom.js";
import { number } from "../ui/format.js";
import { shownUnit, titled, toShown, withShownUnit } from "../ui/units.js";

export const LOAD = "current_load_a";
export const HALF = "current_load_half_width_a";

// the band of a chart round a line; nothing where one of both is not known
export function around(row, x, middle, half, colour) {
  const edge = (way) => Float64Array.from(middle, (value, at) => (Number.isFinite(half[at]) ? value + way * half[at] : NaN));
  return { row, x, low: edge(-1), high: edge(1), colour };
}

// the newest value that is known, as it is read: it is found for a moment of each search, and holds until the next
export function newest(rows) {
  const values = rows.column(LOAD) ?? [];
  let at = values.length - 1;
  while (at >= 0 && !Number.isFinite(values[at])) at -= 1;
  if (at < 0) return null;
  const half = rows.column(HALF)?.[at] ?? NaN;
  return `${values[at].toFixed(3)}${Number.isFinite(half) ? ` ± ${half.toFixed(3)}` : ""} A`.replaceAll("-", "−");
}

const weight = (value) => number(toShown(value, "kg"), 3);

// trials with their results -> rows to show; those that looked for no load are left out
export function loadsOf(trials) {
  return trials.filter((trial) => typeof trial.results?.reflected_load_kg === "number").map((trial) => {
    const [low, high] = trial.results.reflected_interval_kg ?? [null, null];
    return { name: trial.name, known: trial.conditions.load_kg ?? null, found: trial.results.reflected_load_kg, low, high };
  });
}

export function loadBands(place, trials) {
  const loads = loadsOf(trials);
  if (!loads.length) {
    replace(place);
    return;
  }
  const latest = loads.at(-1);
  const band = latest.low === null ? "" : ` (95 %: ${weight(latest.low)} to ${weight(latest.high)} ${shownUnit("kg").unit})`;
  replace(place, h("h3", {}, "Reflected load"),
    h("p", { class: "reading" }, h("strong", {}, `${weight(latest.found)} ${shownUnit("kg").unit}`), `${band}${latest.known === null ? "" : `, hung: ${withShownUnit(latest.known, "kg", 3)}`}`),
    table("Reflected load of each trial", [
      { title: "Trial", cell: (one) => one.name },
      { title: titled("Found", "kg"), number: true, cell: (one) => weight(one.found) },
      { title: titled("95 %", "kg"), number: true, cell: (one) => (one.low === null ? "–" : `${weight(one.low)} to ${weight(one.high)}`) },
      { title: titled("Hung", "kg"), number: true, cell: (one) => (one.known === null ? "–" : weight(one.known)) },
      { title: titled("Error", "kg"), number: true, cell: (one) => (one.known === null ? "–" : weight(one.found - one.known)) },
    ], [...loads].reverse()));
}
