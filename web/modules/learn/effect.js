// One effect: physics, equation, parameters, what excites it, what it is confused with, and an example to play with.
// A joint that is swung, without an effect and with as much of it as the slider says; and the effect over what drives it.

import { get } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { Chart } from "../plots/chart.js";
import { facts, h, panel, replace } from "../ui/dom.js";
import { equation } from "./equation.js";
import { nameOf, number } from "../ui/format.js";
import { colour, SERIES } from "../ui/colours.js";
import { draw } from "../plots/plotly.js";
import { shownUnit, titled, withShownUnit } from "../ui/units.js";

export function effectView(place, name) {
  const [text, picture] = [h("div"), h("div", { class: "example" })];
  let plot = null;
  let left = false;
  replace(place, h("p", {}, h("a", { href: "#learn" }, "All effects")), text);
  const described = attempt(text, async () => {
    const { items } = await get("/effects");
    const effect = items.find((one) => one.name === name);
    if (!effect) throw new Error(`There is no effect ${name}.`);
    replace(text, description(effect, items));
  });
  const shown = described.then(() => { // what is above it does not push it down
    if (!left) place.append(panel("A simulated example", picture));
  });
  attempt(picture, async () => {
    const [example] = await Promise.all([get(`/effects/${encodeURIComponent(name)}/example`), shown]);
    if (!left) plot = examplePlot(picture, example);
  }, { busy: "Computing …" });
  together(place, [shown]);
  return () => {
    left = true;
    plot?.close();
  };
}

function description(effect, all) {
  const parameters = effect.parameters.map((one) => `${one.name} [${one.unit}], ${bound(one.low, "−∞")} to ${bound(one.high, "∞")}`);
  const titles = (names) => names.map((name, index) => [index > 0 && ", ", h("a", { href: `#learn/${name}` }, all.find((one) => one.name === name)?.title ?? name)]);
  return panel(effect.title, h("p", { class: "lead" }, effect.physics), equation(effect.equation),
    facts([["parameters", parameters.join("; ")], ["driven by", nameOf(effect.driver)], ["needs", effect.channels.map(nameOf).join(", ") || "position and effort"],
      ["excited by", [effect.excited_by].flat().join(", ")], ["confused with", effect.confused_with.length ? titles(effect.confused_with) : "–"],
      ["source", effect.source], ["name", effect.name]]));
}

function bound(value, none) {
  return value === null || value === undefined ? none : number(value);
}

const MOST = 2; // of the size that the service proposes

export function examplePlot(place, example) {
  const slider = h("input", { type: "range", id: "example-size", min: "0", max: String(MOST), step: "0.05", value: "1" });
  const load = h("select", { id: "example-load" }, example.trials.map((trial, index) => h("option", { value: String(index) }, `${withShownUnit(trial.load_kg, "kg")} at the tip`)));
  const [time, driver] = [h("div"), h("div", { class: "plot", role: "figure", "aria-label": `What the effect adds, against ${nameOf(example.driver)}` })];
  replace(place, h("p", { class: "soft" }, `${example.motion} The slider changes how much of the effect there is; a model without it would be wrong by the lower curve.`),
    h("div", { class: "row" }, h("label", { for: "example-size" }, "How much of it", slider), h("label", { for: "example-load" }, "Load", load)), time, driver);
  const chart = new Chart(time, { label: "Effort of the joint with and without the effect", height: 340 });
  const show = () => {
    const trial = example.trials[Number(load.value)];
    chart.show(contentOf(trial, Number(slider.value), example.effort_unit));
    return draw(driver, overDriver(example, Number(slider.value)), { height: 280, xaxis: { title: { text: driverTitle(example) } },
      yaxis: { title: { text: `what it adds [${example.effort_unit}]` } } });
  };
  for (const input of [slider, load]) input.addEventListener("input", show);
  show();
  return chart;
}

function contentOf(trial, size, unit) {
  const x = Float64Array.from(trial.time_s);
  const added = Float64Array.from(trial.effect, (value) => size * value);
  return { rows: [{ title: `effort [${unit}]` }, { title: `added [${unit}]` }], xTitle: "time [s]", lines: [
    { row: 0, name: "without", colour: "blue", x, y: Float64Array.from(trial.without) },
    { row: 0, name: "with", colour: "orange", dash: [6, 4], width: 2, x, y: added.map((value, index) => value + trial.without[index]) },
    { row: 1, name: "added by the effect", colour: "red", x, y: added }] };
}

function driverTitle({ driver, driver_unit: si }) {
  return si ? titled(nameOf(driver), si) : nameOf(driver);
}

function overDriver(example, size) {
  const { factor } = shownUnit(example.driver_unit);
  return example.trials.map((trial, index) => ({ x: trial.driver.map((value) => value === null ? null : value * factor), y: trial.effect.map((value) => size * value), mode: "markers", name: withShownUnit(trial.load_kg, "kg"),
    showlegend: true, marker: { size: 5, symbol: index ? "diamond" : "circle", color: colour(SERIES[index]) } }));
}
