// A model in closed loop: does its joint go where the measured one went, under the servo of the trial; coefficients refined by that.

import { get } from "../app/api.js";
import { patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { number, percent } from "../ui/format.js";
import { Chart } from "../plots/chart.js";
import { shownUnit } from "../ui/units.js";

const TOLD = { bench: "the bench", recording: "set point and effort", "stand-in": "nobody: a stand-in" };

// linked: the plots whose cursor this one shares
export function closedLoop(place, path, { model_id, linked }) {
  const answer = h("div");
  const ask = async (button, refine, busy) => {
    const found = await patiently(answer, "closed-loop", busy, (signal, job) => get(`${path}/closed-loop`, { model_id, refine }, { signal, job }), { button });
    if (found) show(answer, found, linked);
  };
  const simulate = h("button", { type: "button" }, "Simulate");
  const refine = h("button", { type: "button" }, "Simulate and refine");
  simulate.addEventListener("click", () => ask(simulate, false, "Moving the model's joint …"));
  refine.addEventListener("click", () => ask(refine, true, "Moving the model's joint, and refining its coefficients …"));
  replace(place, h("p", { class: "soft" }, "Does the joint of the model go where the measured one went, under the servo of each trial? Refining regresses the effort along the simulated motion."),
    h("div", { class: "row centre" }, simulate, refine), answer);
}

function show(place, found, linked) {
  const plot = h("div");
  const choice = h("select", { id: "loop-trial", onchange: () => picture(chart, found, Number(choice.value)) },
    found.trials.map((trial, index) => h("option", { value: String(index), selected: index === worst(found.trials) }, trial.name)));
  replace(place, errorTable(found), found.refined && refinement(found.refined),
    h("label", { for: "loop-trial" }, "Trial", choice), plot, trialTable(found), found.notes.map((note) => h("p", {}, note)));
  const chart = new Chart(plot, { label: "Measured and simulated position", height: 360 });
  linked.timed(chart, () => found.trials[Number(choice.value)].trial_id);
  picture(chart, found, worst(found.trials));
}

// the trial whose position is the farthest off, of what it moves
export function worst(trials) {
  const errors = trials.map((trial) => trial.position_relative ?? -1);
  return errors.indexOf(Math.max(...errors));
}

function errorColumns(unit) {
  return [
    { title: `Position, rms [${unit}]`, number: true, cell: (one) => number(one.position, 3) },
    { title: "Position, of its spread", number: true, cell: (one) => percent(one.position_relative) },
    { title: "Speed", number: true, cell: (one) => percent(one.velocity_relative) },
    { title: "Effort", number: true, cell: (one) => percent(one.effort_relative) },
  ];
}

function errorTable({ training, held_out, refined, position_unit }) {
  const rows = [["training", training], ["held out", held_out], ["training, refined", refined?.training], ["held out, refined", refined?.held_out]];
  return table("Errors in closed loop", [{ title: "On", cell: (one) => one.on }, ...errorColumns(position_unit)],
    rows.filter(([, error]) => error).map(([on, error]) => ({ on, ...error })));
}

function trialTable({ trials, position_unit }) {
  return table("Errors in closed loop per trial", [
    { title: "Trial", cell: (trial) => trial.name },
    { title: "Role", cell: (trial) => trial.role.replace("_", "-") },
    { title: "Servo told by", cell: (trial) => TOLD[trial.law] },
    ...errorColumns(position_unit),
    { title: "Settled", cell: (trial) => (trial.settled ? "" : "no") },
  ], trials);
}

function refinement(refined) {
  return [h("p", {}, refined.sentence), table("Coefficients by least squares and refined", [
    { title: "Coefficient", cell: (one) => [one.name, h("div", { class: "hint" }, one.effect.replaceAll("_", " "))] },
    { title: "By least squares", number: true, cell: (one) => number(one.before, 4) },
    { title: "Refined", number: true, cell: (one) => number(one.after, 4) },
    { title: "Unit", cell: (one) => one.unit },
  ], refined.parameters)];
}

// both motions, and beneath them by how much they differ: on the scale of the motion that is not to be seen
function picture(chart, { trials, position_unit }, index) {
  const { time_s: x, measured, simulated } = trials[index].series;
  const { unit, factor } = shownUnit(position_unit);
  const line = (row, name, values, colour, dash) => ({ row, name, x, y: values.map((value) => factor * value), colour, dash });
  chart.show({ rows: [{ title: `position [${unit}]` }, { title: `difference [${unit}]` }], xTitle: "time in the trial [s]", lines: [line(0, "measured", measured, "blue"),
    line(0, "simulated", simulated, "red", [6, 4]), line(1, "simulated less measured", simulated.map((value, at) => value - measured[at]), "purple")] });
  chart.showAll();
}
