// Live: what the joint does, drawn with each frame while rows arrive; frozen, zoomed, channel by channel.

import { poweredOff, readingNote } from "../app/state.js";
import { liveJoint } from "../joint/livejoint.js";
import { Chart } from "../plots/chart.js";
import { SERIES } from "../ui/colours.js";
import { h, replace } from "../ui/dom.js";
import { axisTitle, fixed, nameOf, number, PLOTTED, unitOf } from "../ui/format.js";
import { allShown, shownUnit } from "../ui/units.js";
import { LatestTrials } from "./latesttrials.js";
import { around, HALF, LOAD, loadBands, newest } from "./load.js";
import { markLegend, marksOf } from "../plots/marks.js";

const SECONDS = [["0", "all of the trial"], ["5", "last 5 s"], ["20", "last 20 s"]];
const DRAWN = [
  { name: "target_rad", colour: "orange", dash: [5, 4] },
  { name: "position_rad", colour: "blue" },
  { name: "velocity_rad_s", colour: "green" },
  { name: "current_a", colour: "red" },
  { name: "current_estimate_a", colour: "orange" },
  { name: "current_load_a", text: "load current (band: 95 %)", colour: "sky", width: 3 },
  { name: "duty", colour: "purple" },
  { name: "supply_v", colour: "orange", off: true },
  { name: "temperature_c", colour: "red", off: true },
];
const OTHERS = PLOTTED.filter((name) => DRAWN.every((one) => one.name !== name)).map((name, at) => ({ name, colour: SERIES[at % SERIES.length] }));
const CHANNELS = [...DRAWN, ...OTHERS].map((one) => ({ text: nameOf(one.name), unit: unitOf(one.name), ...one }));

// the least that an axis spans, in SI: a joint at rest is a flat line, not its sensor's noise over the whole height
const LEAST_SPAN = { rad: 0.05, "rad/s": 0.2, A: 0.05, "": 0.02, V: 1, degC: 1 };

export function livePlot(place, { live, state }) {
  const progress = h("progress", { max: "1", value: "0", "aria-label": "Progress of the experiment" });
  const outcome = h("p", { class: "soft", role: "status" });
  const [joint, age] = [h("div", { class: "live-joint" }), h("p", { class: "soft age" })];
  const readings = h("dl", { class: "readings" });
  const note = h("p", { class: "soft" });
  const loads = h("div");
  const boxes = CHANNELS.map((one) => h("input", { type: "checkbox", checked: !one.off, value: one.name }));
  const freeze = h("input", { type: "checkbox", id: "freeze" });
  const seconds = h("select", { "aria-label": "Shown time" }, SECONDS.map(([value, text]) => h("option", { value }, text)));
  const picture = h("div", { class: "live-plots" });
  place.className = "live";
  replace(place, progress, outcome, h("div", { class: "live-now" }, joint, h("div", {}, readings, age)), h("div", { class: "row centre" }, h("label", { class: "inline" }, freeze, "freeze"), seconds,
    h("details", {}, h("summary", {}, "Channels"), h("div", { class: "row centre" },
      CHANNELS.map((one, index) => h("label", { class: "inline" }, boxes[index], one.unit ? `${one.text} [${shownUnit(one.unit).unit}]` : one.text))))), picture, note, loads);
  const chart = new Chart(picture, { label: "Position, speed, current and duty of the trial that runs", height: 520 });
  const latest = new LatestTrials(live);

  let frozen = null;
  let shownLength = 0;
  let load = { experiment: null, text: null }; // of the trial that runs, or of one before it in the same experiment
  const show = () => {
    const chosen = CHANNELS.filter((one, index) => boxes[index].checked);
    const content = frozen ? contentOf(frozen.rows, chosen, frozen.marks, Number(seconds.value)) : contentOf(live.rows, chosen, marksOf(latest.events), Number(seconds.value));
    if (!frozen && live.rows.length < shownLength) chart.showAll(); // another trial has begun
    shownLength = live.rows.length;
    chart.show(content);
    picture.hidden = !content.lines.length;
    note.textContent = content.lines.length ? markLegend(content.marks) || "\u00a0" : "No rows yet: they appear here while an experiment runs.";
  };
  const status = () => {
    const run = live.status?.run;
    progress.value = run?.progress ?? 0;
    outcome.textContent = run ? sentence(run) : "Nothing has run yet. Start an experiment.";
    const before = load.experiment === run?.experiment_id ? load.text : null;
    load = { experiment: run?.experiment_id, text: newest(live.rows) ?? before };
    replace(readings, readingsOf(live.status?.reading, load.text, poweredOff(state.now)));
  };
  const aged = () => {
    const { dimmed, words } = readingNote(state.now);
    place.classList.toggle("stale", !state.now.fresh);
    readings.classList.toggle("dimmed", dimmed);
    age.textContent = words || "\u00a0";
  };
  // the chart draws once a frame, however often it is told
  const update = () => { if (!freeze.checked && !document.hidden) show(); };
  const trials = () => {
    update();
    loadBands(loads, latest.trials);
  };
  freeze.addEventListener("change", () => {
    frozen = freeze.checked ? { rows: live.rows.copy(), marks: marksOf(latest.events) } : null;
    show();
  });
  for (const box of [...boxes, seconds]) box.addEventListener("change", show);
  live.addEventListener("rows", update);
  live.addEventListener("status", status);
  latest.addEventListener("change", trials);
  state.addEventListener("change", aged);
  const leaveJoint = liveJoint(joint, { live, state }, latest);
  show();
  status();
  aged();
  return () => {
    state.removeEventListener("change", aged);
    leaveJoint();
    latest.close();
    chart.close();
    live.removeEventListener("rows", update);
    live.removeEventListener("status", status);
  };
}

// rows of the ring -> what the chart draws; channels that are not measured have no line, units without lines no row
function contentOf(rows, chosen, marks, seconds) {
  const all = rows.column("time_s") ?? new Float64Array();
  const measured = chosen.filter((one) => rows.column(one.name)?.some(Number.isFinite));
  const units = [...new Set(measured.map((one) => one.unit))];
  const last = all.at(-1) ?? 0;
  const lines = measured.map((one) => ({ row: units.indexOf(one.unit), name: one.text, x: all, y: allShown(rows.column(one.name), one.unit), colour: one.colour, dash: one.dash, width: one.width }));
  const load = measured.find((one) => one.name === LOAD);
  const bands = load && rows.column(HALF) ? [around(units.indexOf(load.unit), all, rows.column(LOAD), rows.column(HALF), load.colour)] : [];
  return {
    rows: units.length ? units.map((unit) => ({ title: axisTitle(unit, "duty"), least: (LEAST_SPAN[unit] ?? 0) * shownUnit(unit).factor })) : [{ title: "" }], lines, bands,
    marks: marks.filter((one) => one.letter && one.x <= last), xTitle: "time in the trial [s]",
    limits: seconds && all.length ? [Math.max(all[0], last - seconds), last] : undefined,
  };
}

function sentence(run) {
  if (run.outcome === "running") return `Running ${run.kind}: trial ${run.trial_index + 1} of ${run.trial_count}, ${number(Math.round(100 * run.progress))} %.`;
  return `Experiment ${run.experiment_id} (${run.kind}): ${run.outcome}${run.reason ? `: ${run.reason}` : ""}`;
}

// the steps in which readings are shown, in SI: finer ones flicker
const STEPS = { rad: 0.001, "rad/s": 0.005, A: 0.001, "": 0.001, V: 0.01, degC: 0.1 };
const READINGS = ["position_rad", "velocity_rad_s", "current_a", "duty", "supply_v", "temperature_c"];

// what is true only while the power is on: of a joint that coasts or rests, the last values say nothing
const WITH_POWER = ["velocity_rad_s", "current_a", "duty"];

// off: the power was taken off after this reading
export function readingsOf(values, load, off) {
  const known = READINGS.filter((name) => values && values[name] !== null && values[name] !== undefined);
  const label = (name) => `${off && WITH_POWER.includes(name) ? "last " : ""}${name === "current_a" ? currentName(values) : nameOf(name)}`;
  const read = known.map((name) => [label(name), readingText(values[name], unitOf(name))]);
  return [...read, ...(load ? [["load current, as last found", load]] : [])].map(([text, value]) => h("div", {}, h("dt", {}, text), h("dd", {}, value)));
}

// a current that the drive does not measure is called on the whole page what it is made of
export function currentName(reading) {
  return nameOf(reading && reading.current_measured === false ? "current_estimate_a" : "current_a");
}

export function readingText(value, si) {
  const { unit, factor } = shownUnit(si);
  const places = Math.max(0, Math.ceil(-Math.log10(STEPS[si] * factor) - 1e-9));
  return `${fixed(value * factor, places)}${unit.startsWith("°") && unit !== "°C" ? unit : unit && ` ${unit}`}`;
}
