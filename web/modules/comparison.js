// Measured against predicted: over time with the residual beneath, against each driver, per trial and regime.

import { facts, h, panel, replace, table } from "./dom.js";
import { conditions, interval, nameOf, number, percent } from "./format.js";
import { band, colour, draw } from "./plot.js";

const MOST_POINTS = 4000;
const DIRECTIONS = { forward: "blue", backward: "red", both: "green" };

export async function comparison(place, compared) {
  const series = h("div", { class: "plot", role: "img", "aria-label": "Measured and predicted effort over time, residual beneath" });
  const choice = h("select", { id: "series" }, compared.series.map((one, index) => h("option", { value: String(index) }, one.name)));
  const drivers = h("div", { class: "cards" });
  replace(place,
    panel("Measured against predicted", errors(compared), h("label", { for: "series" }, "Trial", choice), series),
    panel("Residual against what drives it", h("p", { class: "soft" }, "Mean of the residual in bins with its band, by direction. A flat line at zero: the model has it. A shape: it is missing."), drivers),
    panel("Where it fits, and its parameters", h("div", { class: "cards" }, trialTable(compared), regimeTable(compared), parameterTable(compared))),
    compared.notes.length ? panel("Notes", compared.notes.map((note) => h("p", {}, note))) : null);
  const show = () => seriesPlot(series, compared.series[Number(choice.value)], compared.effort);
  choice.addEventListener("change", show);
  if (compared.series.length) await show();
  for (const driver of compared.residual_against) {
    const plot = h("div", { class: "plot", role: "img", "aria-label": `Residual against ${nameOf(driver.driver)}` });
    drivers.append(plot);
    await driverPlot(plot, driver, compared.effort);
  }
}

function errors({ error, effort }) {
  const text = (one) => (one ? `${percent(one.relative)} (${number(one.rms, 3)} ${effort.unit} rms)` : "unknown: needs repeated trials");
  const kinds = { "hold-out": "held-out trials", "leave-one-trial-out": "each trial left out in turn", "leave-one-block-out": "stretches left out in turn" };
  return facts([["training error", text(error.training)], [kinds[error.held_out?.kind] ?? "held-out", text(error.held_out)], ["floor from repeats", text(error.floor)]]);
}

function seriesPlot(plot, one, effort) {
  const step = Math.max(1, Math.ceil(one.time_s.length / MOST_POINTS));
  const thin = (values) => values.filter((_, index) => index % step === 0);
  const time = thin(one.time_s);
  const line = (values, name, colourName, extra) => ({ x: time, y: thin(values), name, mode: "lines", line: { color: colour(colourName), width: 1.5, ...extra } });
  return draw(plot, [
    line(one.measured, "measured", "blue"), line(one.predicted, "predicted", "orange", { dash: "dash", width: 2 }),
    { ...line(one.residual, "residual", "red"), yaxis: "y2" },
  ], { height: 440, uirevision: one.trial_id, xaxis: { title: { text: "time [s]" }, anchor: "y2" },
    yaxis: { domain: [0.42, 1], title: { text: `effort [${effort.unit}]` } }, yaxis2: { domain: [0, 0.34], title: { text: `residual [${effort.unit}]` } } });
}

function driverPlot(plot, driver, effort) {
  const traces = driver.groups.flatMap((group) => {
    const name = DIRECTIONS[group.direction] ?? "blue";
    const marker = { symbol: group.direction === "backward" ? "diamond" : "circle", size: 6 };
    return [band(group.x, group.low, group.high, group.direction, name),
      { x: group.x, y: group.mean, name: group.direction, mode: "lines+markers", marker, line: { color: colour(name) }, customdata: group.count, hovertemplate: "%{x:.4g}: %{y:.4g} (%{customdata} rows)" }];
  });
  return draw(plot, traces, { height: 270, xaxis: { title: { text: `${nameOf(driver.driver)}${driver.unit ? ` [${driver.unit}]` : ""}` } },
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

function parameterTable({ parameters }) {
  return table("Parameters", [
    { title: "Parameter", cell: (one) => [one.name.replaceAll("_", " "), h("div", { class: "hint" }, one.effect.replaceAll("_", " "))] },
    { title: "Value (95 %)", number: true, cell: (one) => interval(one.value, one.low, one.high, (value) => number(value, 3)) },
    { title: "Unit", cell: (one) => one.unit },
    { title: "", cell: (one) => one.note },
  ], parameters);
}
