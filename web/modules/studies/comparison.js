// Measured against predicted: over time with the residual beneath, over speed and load, against each driver, per trial and regime.

import { get } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { closedLoop } from "./closedloop.js";
import { facts, h, panel, replace, table } from "../ui/dom.js";
import { errorMap, momentList } from "./errormap.js";
import { conditions, nameOf, number, percent } from "../ui/format.js";
import { milli, shownUnit } from "../ui/units.js";
import { colour } from "../ui/colours.js";
import { band, draw } from "../plots/plotly.js";

const DIRECTIONS = { forward: "blue", backward: "red", both: "green" };

// series: the plot beside it, which shows a moment that is chosen here
export async function comparison(place, compared, { path, series }) {
  const [loop, spots, moments, drivers] = ["div", "div", "div", "div"].map((tag) => h(tag));
  drivers.className = "cards";
  const against = h("details", {}, h("summary", {}, "Residual against what drives it"),
    h("p", { class: "soft" }, "Mean of the residual in bins with its band, by direction. A flat line at zero: the model has it. A shape: it is missing. Choose a point to see when that was."), drivers);
  replace(place,
    panel("Where the model is wrong", errors(compared), spots, moments),
    panel("Closer", against, h("details", {}, h("summary", {}, "Error of each trial and regime"), trialTable(compared), regimeTable(compared)),
      h("details", {}, h("summary", {}, "In closed loop"), h("div", { role: "group", "aria-label": "In closed loop" }, loop)),
      compared.notes.length > 0 && h("details", {}, h("summary", {}, compared.notes.length === 1 ? "1 note" : `${compared.notes.length} notes`), compared.notes.map((note) => h("p", {}, note)))));
  closedLoop(loop, path, compared.model_id);
  const ask = (where, words) => attempt(moments, async () => {
    const query = new URLSearchParams([...where.map((one) => ["where", one]), ["model_id", compared.model_id]]);
    momentList(moments, words, await get(`${path}/moments?${query}`), (one) => series.showMoment(one));
    moments.scrollIntoView({ block: "nearest" });
  }, { busy: "Looking …" });
  attempt(spots, async () => errorMap(spots, await get(`${path}/error-map`, { model_id: compared.model_id }), ask), { busy: "Looking …" });
  against.addEventListener("toggle", async () => {
    if (!against.open || drivers.children.length) return;
    for (const driver of compared.residual_against) {
      const picture = h("div", { class: "plot", role: "figure", "aria-label": `Residual against ${nameOf(driver.driver)}` });
      drivers.append(picture);
      await driverPlot(picture, driver, compared.effort);
      picture.on?.("plotly_click", ({ points }) => ask(...spotOf(driver, points[0])));
    }
  });
}

// the bin around a point: half-way to its neighbours, on the side of its direction
export function spotOf(driver, point) {
  const group = driver.groups[Math.floor(point.curveNumber / 2)];
  const at = point.pointIndex;
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

function driverPlot(plot, driver, effort) {
  const traces = driver.groups.flatMap((group) => {
    const name = DIRECTIONS[group.direction] ?? "blue";
    const marker = { symbol: group.direction === "backward" ? "diamond" : "circle", size: 6 };
    const x = group.x.map((value) => value * shownUnit(driver.unit).factor);
    return [band(x, group.low, group.high, group.direction, name),
      { x, y: group.mean, name: group.direction, mode: "lines+markers", marker, line: { color: colour(name) }, customdata: group.count, hovertemplate: "%{x:.4g}: %{y:.4g} (%{customdata} rows)" }];
  });
  return draw(plot, traces, { height: 270, xaxis: { title: { text: `${nameOf(driver.driver)}${driver.unit ? ` [${shownUnit(driver.unit).unit}]` : ""}` } },
    yaxis: { title: { text: `residual [${effort.unit}]` } } });
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

