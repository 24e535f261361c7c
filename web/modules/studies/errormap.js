// Where the model is wrong: the error over speed and load, as a table whose cells are buttons; one of them shows its moments,
// and where the cursor of the plots stands is framed.
// The moments behind a bad spot: each leads to its place in the trial.

import { h, replace, table } from "../ui/dom.js";
import { nameOf, number } from "../ui/format.js";
import { milli, shownUnit, titled } from "../ui/units.js";

const DARKEST_PERCENT = 45;

// ask(criteria, words): a cell was chosen
export function errorMap(place, map, ask, linked) {
  const highest = Math.max(...map.rms.flat().filter((value) => value !== null), 0);
  const effort = milli(highest, map.effort.unit);
  const head = h("tr", {}, h("td", {}),
    middles(map.across_edges).map((value) => h("th", { scope: "col", class: "number" }, number(value * shownUnit(map.across.unit).factor, 2))));
  const rows = map.rms.map((cells, down) => h("tr", {}, h("th", { scope: "row", class: "number" }, number(middles(map.down_edges)[down] * shownUnit(map.down.unit).factor, 3)),
    cells.map((value, across) => cell(map, { down, across, value, highest, effort }, { ask, linked }))));
  linked.tell((values) => {
    const at = values && [binOf(map.down_edges, values[map.down.driver]), binOf(map.across_edges, values[map.across.driver])];
    for (const [down, row] of rows.entries()) for (const [across, one] of [...row.querySelectorAll("td")].entries()) one.classList.toggle("here", Boolean(at) && down === at[0] && across === at[1]);
  });
  replace(place,
    h("p", { class: "soft" }, `Root mean square of the residual [${effort.unit}]: across over ${titled(nameOf(map.across.title), map.across.unit)}, down over ${titled(nameOf(map.down.title), map.down.unit)}. Choose a cell to see the worst of its moments.`),
    h("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Error over speed and load" },
      h("table", { class: "heat" }, h("thead", {}, head), h("tbody", {}, [...rows].reverse()))));
}

// what lies beyond the outer edges counts in the outer cells
function binOf(edges, value) {
  const above = edges.findLastIndex((edge) => value >= edge);
  return Math.min(Math.max(above, 0), edges.length - 2);
}

function cell(map, { down, across, value, highest, effort }, { ask, linked }) {
  if (value === null) return h("td", { class: "number soft" }, "");
  const [left, right] = [map.across_edges[across], map.across_edges[across + 1]];
  const [low, high] = [map.down_edges[down], map.down_edges[down + 1]];
  const words = `${spanOf(map.across, left, right)}, ${spanOf(map.down, low, high)}`;
  const button = h("button", { type: "button", class: value === highest ? "cell worst" : "cell", "aria-label": `${words}: ${number(effort.factor * value, 2)} ${effort.unit}`,
    title: `${words}: ${number(effort.factor * value, 3)} ${effort.unit} rms, mean ${number(effort.factor * map.mean[down][across], 2)}, ${map.count[down][across]} rows` }, number(effort.factor * value, 2));
  button.style.background = `color-mix(in srgb, var(--heat) ${Math.round((DARKEST_PERCENT * value) / (highest || 1))}%, var(--panel))`;
  button.addEventListener("click", () => ask([`${map.across.driver}=${left}..${right}`, `${map.down.driver}=${low}..${high}`], words));
  const where = { [map.across.driver]: [left, right], [map.down.driver]: [low, high] };
  for (const name of ["pointerenter", "focus"]) button.addEventListener(name, () => linked.shade(where));
  for (const name of ["pointerleave", "blur"]) button.addEventListener(name, () => linked.shade(null));
  return h("td", { class: "number" }, button);
}

function middles(edges) {
  return edges.slice(1).map((edge, index) => (edge + edges[index]) / 2);
}

function spanOf({ title, unit: si }, low, high) {
  const { unit, factor } = shownUnit(si);
  return `${nameOf(title)} ${number(factor * low, 3)} to ${number(factor * high, 3)} ${unit}`.trim();
}

// show(moment): look at it in time; of an effect that is missing, moments have an rms with it, too
export function momentList(place, title, found, show) {
  const withIt = found.items.some((one) => one.rms_with !== undefined);
  const { unit, factor } = milli(Math.max(...found.items.map((one) => one.rms)), found.effort.unit);
  replace(place, h("h3", {}, title), found.items.length
    ? table("Moments", [
      { title: "Trial", cell: (one) => one.name },
      { title: "From [s]", number: true, cell: (one) => one.from_s.toFixed(2) },
      { title: "To [s]", number: true, cell: (one) => one.to_s.toFixed(2) },
      { title: `rms [${unit}]`, number: true, cell: (one) => number(factor * one.rms, 3) },
      withIt ? { title: `with it [${unit}]`, number: true, cell: (one) => number(factor * one.rms_with, 3) } : { title: `mean [${unit}]`, number: true, cell: (one) => number(factor * one.mean, 3) },
      { title: "", cell: (one) => h("button", { type: "button", class: "small", "aria-label": `Show ${one.name} at ${one.from_s.toFixed(2)} s`, onclick: () => show(one) }, "Show") },
    ], found.items)
    : h("p", { class: "soft" }, "No row lies there."));
}
