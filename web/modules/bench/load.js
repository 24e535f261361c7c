// The friction-compensated current, what a master arm is given, with its 95 % band.
// The load that each trial of the experiment found, with its 95 % interval, beside the load that hung there.

import { h, replace, table } from "../ui/dom.js";
import { number } from "../ui/format.js";

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

const grams = (value) => number(1000 * value, 3);

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
  const band = latest.low === null ? "" : ` (95 %: ${grams(latest.low)} to ${grams(latest.high)} g)`;
  replace(place, h("h3", {}, "Reflected load"),
    h("p", { class: "reading" }, h("strong", {}, `${grams(latest.found)} g`), `${band}${latest.known === null ? "" : `, hung: ${grams(latest.known)} g`}`),
    table("Reflected load of each trial", [
      { title: "Trial", cell: (one) => one.name },
      { title: "Found [g]", number: true, cell: (one) => grams(one.found) },
      { title: "95 % [g]", number: true, cell: (one) => (one.low === null ? "–" : `${grams(one.low)} to ${grams(one.high)}`) },
      { title: "Hung [g]", number: true, cell: (one) => (one.known === null ? "–" : grams(one.known)) },
      { title: "Error [g]", number: true, cell: (one) => (one.known === null ? "–" : grams(one.found - one.known)) },
    ], [...loads].reverse()));
}
