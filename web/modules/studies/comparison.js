// Measured against predicted: over time with the residual beneath, over speed and load, against each driver, per trial and regime.

import { get } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { Chart } from "../plots/chart.js";
import { closedLoop } from "./closedloop.js";
import { facts, h, panel, replace, table } from "../ui/dom.js";
import { errorMap, momentList } from "./errormap.js";
import { conditions, nameOf, number, percent } from "../ui/format.js";
import { allShown, milli, shownUnit, titled } from "../ui/units.js";

const DIRECTIONS = { forward: "blue", backward: "red", both: "green" };

// linked: with the plot beside it, which shows a moment that is chosen here. Resolves when nothing more is asked about the model
export function comparison(place, compared, { path, linked }) {
  const { series } = linked;
  const [loop, spots, moments, drivers] = ["div", "div", "div", "div"].map((tag) => h(tag));
  drivers.className = "cards";
  const against = h("details", {}, h("summary", {}, "Residual against what drives it"),
    h("p", { class: "soft" }, "Mean of the residual in bins with its band, by direction. A flat line at zero: the model has it. A shape: it is missing. Choose a point to see when that was."), drivers);
  replace(place,
    panel("Where the model is wrong", errors(compared), spots, moments),
    panel("Closer", against, h("details", {}, h("summary", {}, "Error of each trial and regime"), trialTable(compared), regimeTable(compared)),
      h("details", {}, h("summary", {}, "In closed loop"), h("div", { role: "group", "aria-label": "In closed loop" }, loop)),
      compared.notes.length > 0 && h("details", {}, h("summary", {}, compared.notes.length === 1 ? "1 note" : `${compared.notes.length} notes`), compared.notes.map((note) => h("p", {}, note)))));
  closedLoop(loop, path, { model_id: compared.model_id, linked });
  const ask = (where, words) => attempt(moments, async () => {
    const query = new URLSearchParams([...where.map((one) => ["where", one]), ["model_id", compared.model_id]]);
    const found = await get(`${path}/moments?${query}`);
    momentList(moments, `Moments at ${words}`, found, (one) => series.showMoment(one));
    moments.scrollIntoView({ block: "nearest" });
    if (found.items.length) series.showMoment(found.items[0], { focus: false });
  }, { busy: "Looking …" });
  const mapped = attempt(spots, async () => errorMap(spots, await get(`${path}/error-map`, { model_id: compared.model_id }), ask, linked), { busy: "Looking …" });
  against.addEventListener("toggle", () => {
    if (!against.open || drivers.children.length) return;
    for (const driver of compared.residual_against) driverPlot(drivers, driver, { effort: compared.effort, linked, ask });
  });
  return mapped;
}

// the bin around a point of a line: half-way to its neighbours, on the side of its direction
export function spotOf(driver, { line, index: at }) {
  const group = driver.groups[line];
  const low = at > 0 ? (group.x[at - 1] + group.x[at]) / 2 : group.x[at] - 1e9;
  const high = at < group.x.length - 1 ? (group.x[at] + group.x[at + 1]) / 2 : group.x[at] + 1e9;
  const side = { forward: ["direction=0..1"], backward: ["direction=-1..0"] }[group.direction] ?? [];
  return [[`${driver.driver}=${low}..${high}`, ...side], `${nameOf(driver.driver)} near ${number(group.x[at] * shownUnit(driver.unit).factor, 3)} ${shownUnit(driver.unit).unit}, ${group.direction}`];
}

function errors({ error, effort }) {
  const { unit, factor } = milli(Math.max(error.training.rms, error.held_out?.rms ?? 0), effort.unit);
  const text = (one) => (one ? `${percent(one.relative)} (${number(factor * one.rms, 3)} ${unit} rms)` : "unknown: needs repeated trials");
  const kinds = { "hold-out": "held-out error", "leave-one-trial-out": "held-out error, each trial in turn", "leave-one-block-out": "held-out error, stretches in turn" };
  return facts([["training error", text(error.training)], [kinds[error.held_out?.kind] ?? "held-out error", text(error.held_out)], ["floor from repeats", text(error.floor)]]);
}

// a line for each direction, with its band; a point that is chosen leads to its moments
function driverPlot(place, driver, { effort, linked, ask }) {
  const chart = new Chart(place, { label: `Residual against ${nameOf(driver.driver)}`, height: 250, moves: false });
  const small = milli(Math.max(...driver.groups.flatMap((group) => [...group.low, ...group.high]).map(Math.abs)), effort.unit);
  const scaled = (values) => values.map((value) => small.factor * value);
  const shown = driver.groups.map((group) => ({ mean: scaled(group.mean), low: scaled(group.low), high: scaled(group.high), direction: group.direction,
    colour: DIRECTIONS[group.direction] ?? "blue", x: allShown(group.x, driver.unit) }));
  chart.show({ rows: [{ title: `residual [${small.unit}]` }], xTitle: titled(nameOf(driver.driver), driver.unit),
    lines: shown.map((group) => ({ row: 0, name: group.direction, x: group.x, y: group.mean, colour: group.colour, dots: true, dash: group.direction === "backward" ? [6, 4] : undefined })),
    bands: shown.map((group) => ({ row: 0, x: group.x, low: group.low, high: group.high, colour: group.colour })) });
  chart.addEventListener("choose", () => ask(...spotOf(driver, chart.chosen)));
  linked.over(chart, driver.driver);
}

function trialTable({ trials }) {
  return table("Error per trial", [
    { title: "Trial", cell: (trial) => [trial.name, h("div", { class: "hint" }, conditions(trial.conditions))] },
    { title: "Role", cell: (trial) => trial.role.replace("_", "-") },
    { title: "Error", number: true, cell: (trial) => percent(trial.relative) },
  ], trials);
}

function regimeTable({ regimes, effort }) {
  return table("Error per regime", [
    { title: "Regime", cell: (regime) => nameOf(regime.name) },
    { title: "Rows", number: true, cell: (regime) => regime.rows },
    { title: `rms [${effort.unit}]`, number: true, cell: (regime) => number(regime.rms, 3) },
    { title: "Error", number: true, cell: (regime) => percent(regime.relative) },
  ], regimes);
}
