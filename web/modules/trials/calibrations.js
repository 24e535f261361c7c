// Friction curves: those that were calibrated, their pictures (Figs 2 and 3 of the paper), and which of them the bench uses.

import { get, post } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, panel, replace, table } from "../ui/dom.js";
import { number, when } from "../ui/format.js";
import { colour, SERIES } from "../ui/colours.js";
import { draw } from "../plots/plotly.js";
import { shownUnit, titled, toShown, withShownUnit } from "../ui/units.js";
import { calibrationRun } from "./calibrationrun.js";

// returns {first, leave}; first: when the list is there
export function calibrations(place) {
  const [list, picture] = [h("div"), h("div")];
  const from = h("input", { id: "calibrate-from", placeholder: "such as 1, 2" });
  const answer = h("div");
  const button = h("button", {}, "Calibrate");
  const refresh = () => attempt(list, async () => replace(list, calibrationTable((await get("/calibrations")).items, show, use)));
  const show = (one) => attempt(picture, async () => drawCurves(picture, one, await get(`/calibrations/${one.calibration_id}/picture`)));
  const use = (one) => attempt(answer, async () => {
    await post(`/calibrations/${one.calibration_id}/use`);
    await refresh();
  });
  const submit = async (event) => {
    event.preventDefault();
    const experiment_ids = from.value.split(/[,;\s]+/).filter(Boolean).map(Number);
    const made = await attempt(answer, () => post("/calibrations", { experiment_ids }), { button, busy: "Fitting …" });
    if (!made) return;
    await refresh();
    await show(made);
  };
  const run = h("div");
  const running = calibrationRun(run, async (id) => {
    await refresh();
    await show({ calibration_id: id });
  });
  replace(place, panel("Friction curves", run, h("div", { class: "gap" }), list, h("form", { class: "row", onsubmit: submit },
    h("label", { for: "calibrate-from" }, "From experiments (speed sweeps, load sweeps)", from), button), answer, picture));
  return { first: Promise.all([running.first, refresh()]), leave: running.leave };
}

function calibrationTable(items, show, use) {
  if (!items.length) return h("p", { class: "soft" }, "None yet.");
  return table("Friction curves", [
    { title: "Calibration", number: true, cell: (one) => one.calibration_id },
    { title: "From experiments", cell: (one) => one.experiment_ids.join(", ") },
    { title: titled("Loads", "kg"), cell: (one) => one.curves.map((curve) => number(toShown(curve.load_kg, "kg"), 3)).join(", ") },
    { title: "At rest", cell: (one) => one.at_rest || "both sides" },
    { title: "Made", cell: (one) => when(one.created_utc) },
    { title: "", unseen: "In use", cell: (one) => (one.in_use ? h("span", { class: "badge completed" }, "in use") : null) },
    { title: "", cell: (one) => h("div", { class: "actions" },
      h("button", { type: "button", class: "small", "aria-label": `Picture of calibration ${one.calibration_id}`, onclick: () => show(one) }, "Picture"),
      !one.in_use && h("button", { type: "button", class: "small", "aria-label": `Use calibration ${one.calibration_id}`, onclick: () => use(one) }, "Use")) },
  ], items);
}

async function drawCurves(place, one, found) {
  const [currents, duties] = ["Friction current over speed (Fig. 2)", "Friction part of the duty over speed (Fig. 3)"]
    .map((title) => h("div", { class: "plot", role: "figure", "aria-label": title }));
  replace(place, h("h3", {}, `Calibration ${one.calibration_id}`), h("div", { class: "cards" }, currents, duties));
  const x = { title: { text: titled("speed of the motor shaft", "rad/s") } };
  await draw(currents, traces(found.curves, "friction_a"), { height: 320, xaxis: x, yaxis: { title: { text: "friction current [A]" } } });
  await draw(duties, traces(found.curves, "friction_duty"), { height: 320, xaxis: x, yaxis: { title: { text: "duty" } } });
}

function speeds({ motor_speed_rad_s: values }) {
  const { factor } = shownUnit("rad/s");
  return values.map((value) => value * factor);
}

function traces(curves, quantity) {
  return curves.flatMap((one, index) => {
    const name = colour(SERIES[index % SERIES.length]);
    const symbol = one.points.backward.map((backward) => (backward ? "diamond-open" : "circle"));
    if (!one.curve[quantity]) return [];
    return [{ x: speeds(one.points), y: one.points[quantity], mode: "markers", showlegend: false, marker: { color: name, symbol, size: 6 }, hovertemplate: "%{x:.4g}: %{y:.4g}" },
      { x: speeds(one.curve), y: one.curve[quantity], mode: "lines", name: withShownUnit(one.load_kg, "kg", 3), showlegend: true, line: { color: name, width: 2 } }];
  });
}
