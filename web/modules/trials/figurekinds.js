// What each kind of experiment has to show, from the results of its trials. Pure.
// A figure: {title, text, x, y, groups: [{name, x, y, low, high, symbol}], diagonal}, in the units that are shown; the
// drawing is in figures.js.

import { shownUnit, titled, withShownUnit } from "../ui/units.js";

const COLOURS = 6; // then they come again, with another symbol
const SYMBOLS = ["circle", "square", "diamond"];
const shown = (si) => (value) => value * shownUnit(si).factor;
const load = (value) => shown("kg")(value);
const speed = (value) => shown("rad/s")(value);
const known = (trials, name) => trials.filter((trial) => typeof trial.results?.[name] === "number");
const values = (trials, read) => trials.map(read);

export const FIGURES = {
  steps: repeatedSteps, "load-sweep": loadSweep, "speed-sweep": frictionCurve, "steady-speeds": loadInMotion, "breakaway-ramps": breakaways,
  reversals: strokes, "coast-down": coasts, "hold-and-soak": soaking, teleoperation: reflected,
};

// kinds whose figure is made from the samples: current over speed shows friction as a step at zero, viscous friction as a slope
export const SAMPLED = ["chirp", "multisine", "sinusoid", "waveform", "excitation"];

function repeatedSteps(trials) {
  const found = known(trials, "load_current_a");
  const x = values(found, (trial) => speed(trial.conditions.approach_rad_s));
  return { title: "Repeated steps: the current at rest, and the load's share of it (Fig. 4)", x: titled("speed of the approach", "rad/s"), y: "current [A]",
    text: "Friction holds the joint wherever it comes to rest, so the current differs from step to step; what the zero-speed search finds does not. Bars: 95 %.",
    groups: [{ name: "current at rest", x, y: values(found, (trial) => trial.results.steady_current_a), colour: "orange" },
      { name: "of the load alone", x, y: values(found, (trial) => trial.results.load_current_a), symbol: "diamond", colour: "blue", ...ends(found, "load_interval_a") }] };
}

function loadSweep(trials) {
  const found = known(trials, "reflected_load_kg");
  return { title: "Load sweep: the load that is reflected, over the load that hangs there (Table 1)", x: titled("load hung", "kg"), y: titled("load found", "kg"),
    text: "On the line, the load is found as it is. Bars: 95 %.", diagonal: true,
    groups: [{ name: "found", x: values(found, (trial) => load(trial.conditions.load_kg)), y: values(found, (trial) => load(trial.results.reflected_load_kg)),
      ...ends(found, "reflected_interval_kg", load) }] };
}

function frictionCurve(trials) {
  const found = known(trials, "motor_speed_rad_s");
  const groups = split(found, (trial) => withShownUnit(trial.conditions.load_kg ?? 0, "kg", 3), (some, at) => ({
    x: values(some, (trial) => speed(trial.results.motor_speed_rad_s)), y: values(some, (trial) => trial.results.current_a), size: 7,
    symbol: values(some, (trial) => `${SYMBOLS[Math.floor(at / COLOURS) % SYMBOLS.length]}${trial.results.saturated ? "" : "-open"}`) }));
  return { title: "Speed sweep: current at each speed (Fig. 2)", x: titled("speed of the motor shaft", "rad/s"), y: "current [A]",
    text: "Once the speed is steady (filled), all of the current is friction; open: it was still gaining speed. The friction curves under Friction curves are fitted to these.", groups };
}

function loadInMotion(trials) {
  const found = known(trials, "forward_mean_error_kg");
  const x = values(found, (trial) => speed(trial.conditions.speed_rad_s));
  return { title: "Steady speeds: error of the load that is reflected in motion", x: titled("speed", "rad/s"), y: titled("error", "kg"),
    text: "Of the mean over each stroke, by direction. What differs between the directions is friction that was not taken off.",
    groups: ["forward", "backward"].map((way) => ({ name: way, x, y: values(found, (trial) => load(trial.results[`${way}_mean_error_kg`])), symbol: way === "forward" ? "circle" : "diamond" })) };
}

function breakaways(trials) {
  const found = trials.flatMap((trial) => (trial.results?.breakaways ?? []).filter((one) => typeof one.current_a === "number").map((one) => ({ ...trial.conditions, ...one })));
  const groups = split(found, (one) => `after ${one.dwell_s} s at rest, ${one.direction > 0 ? "up" : "down"}`, (some) => ({
    x: values(some, (one) => one.rate_a_s), y: values(some, (one) => Math.abs(one.current_a)), symbol: some[0].direction > 0 ? "triangle-up" : "triangle-down" }));
  return { title: "Breakaway: the current at which the joint lets go", x: "rate of the ramp [A/s]", y: "current at slip, without its sign [A]", logarithmic: true,
    text: "Higher after a longer rest: static friction grows with dwell. Higher on a faster ramp: breakaway depends on the rate.", groups };
}

function strokes(trials) {
  const found = known(trials, "friction_current_a").toSorted((one, other) => one.conditions.amplitude_rad - other.conditions.amplitude_rad);
  const x = values(found, (trial) => shown("rad")(trial.conditions.amplitude_rad));
  return { title: "Reversals: friction over the length of the stroke", x: titled("amplitude that was asked for", "rad"), y: "current [A]", logarithmic: true,
    text: "Short strokes stay within pre-sliding and free play: less friction is seen there than on long ones.",
    groups: [{ name: "friction", x, y: values(found, (trial) => trial.results.friction_current_a) },
      { name: "load", x, y: values(found, (trial) => trial.results.load_current_a), symbol: "diamond" }] };
}

function coasts(trials) {
  const groups = split(known(trials, "coast_s"), (trial) => trial.conditions.direction, (some) => ({
    x: values(some, (trial) => speed(trial.results.released_speed_rad_s)), y: values(some, (trial) => trial.results.coast_s), symbol: some[0].conditions.direction === "forward" ? "circle" : "diamond" }));
  return { title: "Coast-down: how long the joint runs by itself", x: titled("speed when it is released", "rad/s"), y: "until it rests [s]",
    text: "A straight line through zero is dry friction alone; what bends it down grows with speed.", groups };
}

function soaking(trials) {
  const found = known(trials, "friction_current_a");
  const warm = found.filter((trial) => typeof trial.results.temperature_c === "number");
  return { title: "Hold and soak: friction as the joint warms up", x: "time of soaking [s]", y: "current [A]",
    text: warm.length ? `The drive was at ${Math.round(warm[0].results.temperature_c)} °C at first, and at ${Math.round(warm.at(-1).results.temperature_c)} °C in the end.` : "The drive measures no temperature.",
    groups: [{ name: "friction", x: values(found, (trial) => trial.conditions.soaked_s), y: values(found, (trial) => trial.results.friction_current_a) }] };
}

function reflected(trials) {
  const groups = split(known(trials, "reflected_error_rms_g"), (trial) => trial.conditions.reflect, (some) => ({
    x: values(some, (trial) => `${trial.conditions.reflect} ${trial.conditions.repeat}`), y: values(some, (trial) => trial.results.reflected_error_rms_g * (shownUnit("kg").factor / 1000)) }));
  return { title: "Master and slave: error of the load that is reflected", x: "what is reflected, and which repeat", y: titled("error, root mean square", "kg"), columns: true,
    text: "Compensated: the friction of the slave is taken off its current first.", groups };
}

// trials by what they have in common -> groups, in the order in which they came
function split(found, name, group) {
  const kinds = Map.groupBy(found, name);
  return [...kinds].map(([text, some], at) => ({ name: text, ...group(some, at) }));
}

function ends(found, name, show = (value) => value) {
  const intervals = found.map((trial) => trial.results[name]);
  return intervals.every(Boolean) ? { low: intervals.map(([low]) => show(low)), high: intervals.map(([, high]) => show(high)) } : {};
}
