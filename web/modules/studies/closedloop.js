// A model in closed loop: does its joint go where the measured one went, under the servo of the trial; coefficients refined by that.

import { get } from "../app/api.js";
import { patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { number, percent } from "../ui/format.js";
import { colour } from "../ui/colours.js";
import { draw } from "../plots/plotly.js";

const TOLD = { bench: "the bench", recording: "set point and effort", "stand-in": "nobody: a stand-in" };

export function closedLoop(place, path, model_id) {
  const answer = h("div");
  const ask = async (button, refine, busy) => {
    const found = await patiently(answer, "closed-loop", busy, (signal) => get(`${path}/closed-loop`, { model_id, refine }, { signal }), { button });
    if (found) await show(answer, found);
  };
  const simulate = h("button", { type: "button" }, "Simulate");
  const refine = h("button", { type: "button" }, "Simulate and refine");
  simulate.addEventListener("click", () => ask(simulate, false, "Moving the model's joint …"));
  refine.addEventListener("click", () => ask(refine, true, "Moving the model's joint, and refining its coefficients …"));
  replace(place, h("p", { class: "soft" }, "Does the joint of the model go where the measured one went, under the servo of each trial? Refining regresses the effort along the simulated motion."),
    h("div", { class: "row centre" }, simulate, refine), answer);
}

async function show(place, found) {
  const plot = h("div", { class: "plot", role: "figure", "aria-label": "Measured and simulated position" });
  const choice = h("select", { id: "loop-trial", onchange: () => picture(plot, found, Number(choice.value)) },
    found.trials.map((trial, index) => h("option", { value: String(index), selected: index === worst(found.trials) }, trial.name)));
  replace(place, errorTable(found), found.refined && refinement(found.refined),
    h("label", { for: "loop-trial" }, "Trial", choice), plot, trialTable(found), found.notes.map((note) => h("p", {}, note)));
  await picture(plot, found, worst(found.trials));
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
function picture(plot, { trials, position_unit }, index) {
  const { time_s, measured, simulated } = trials[index].series;
  const line = (name, y, hue, extra) => ({ x: time_s, y, name, mode: "lines", line: { color: colour(hue), width: 2, ...extra } });
  const apart = { ...line("simulated less measured", simulated.map((value, at) => value - measured[at]), "purple"), yaxis: "y2" };
  const axis = (text, domain) => ({ title: { text: `${text} [${position_unit}]` }, domain });
  return draw(plot, [line("measured", measured, "blue"), line("simulated", simulated, "red", { dash: "dash" }), apart],
    { height: 360, xaxis: { title: { text: "time [s]" }, anchor: "y2" }, yaxis: axis("position", [0.45, 1]), yaxis2: axis("difference", [0, 0.35]) });
}
