// Numbers, units and names as people read them.

import { shownUnit, titled, withShownUnit } from "./units.js";

// written into the page by the service: units by the ending of a name, and what the channels are called
const NAMES = JSON.parse(document.getElementById("names").textContent);
const ENDINGS = Object.keys(NAMES.units).sort((one, other) => other.length - one.length);

function endingOf(name) {
  return ENDINGS.find((ending) => name.endsWith(ending)) ?? "";
}

export function unitOf(name) {
  return NAMES.units[endingOf(name)] ?? "";
}

// channels that a plot shows unless asked otherwise
export const PLOTTED = NAMES.plotted;

// what a channel is called on the whole page, with its unit or without
const SAID = Object.fromEntries(Object.entries(NAMES.channels).flatMap(([name, label]) => [[name, label], [bareOf(name), label]]));

function bareOf(name) {
  return name.slice(0, name.length - endingOf(name).length);
}

export function nameOf(name) {
  return SAID[name] ?? SAID[bareOf(name)] ?? bareOf(name).replace(/\bvelocity(?=_|$)/, "speed").replaceAll("_", " ");
}

const AXES = { rad: "angle", "rad/s": "speed", m: "position", "m/s": "speed", A: "current", "N m": "torque", N: "force", V: "supply", degC: "temperature" };

// title of an axis for all that has an SI unit, in the unit that is shown
export function axisTitle(si, other = "") {
  const { unit } = shownUnit(si);
  return unit ? `${AXES[si] ? `${AXES[si]} ` : ""}[${unit}]` : other;
}

export function withUnit(name) {
  return titled(nameOf(name), unitOf(name));
}

// to be read; what is typed and read back is `plain`
export function number(value, digits = 4) {
  const text = plain(value, digits);
  return typeof value === "number" ? text.replaceAll("-", "−") : text;
}

export function plain(value, digits = 4) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e6) return String(value);
  return String(Number(value.toPrecision(digits)));
}

// always as many places, and never "−0.000"
export function fixed(value, places) {
  const text = value.toFixed(places);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

// a value whose name tells its unit, in the units that are shown
export function quantity(name, value) {
  if (Array.isArray(value)) return value.map((one) => quantity(name, one)).join(", ");
  return typeof value === "number" ? withShownUnit(value, unitOf(name)) : number(value);
}

const ROUNDING = 1e-7;

// a small one by its first two digits: those after the point would say next to nothing of it
export function percent(share, digits = 2) {
  if (share === null || share === undefined) return "–";
  const small = Math.abs(share) > ROUNDING && Math.abs(100 * share) < 5 * 10 ** -digits;
  return `${small ? number(100 * share, 2) : fixed(100 * share, digits)} %`;
}

export function interval(value, low, high, show = percent) {
  return low === null || low === undefined ? show(value) : `${show(value)} (${show(low)} to ${show(high)})`;
}

// the service's words as a sentence of its own; names such as load_kg stay as they are
export function capital(text) {
  return /^[a-z]+[ ,;:]/.test(text) ? text[0].toUpperCase() + text.slice(1) : text;
}

const MADE_FOR_PROGRAMS = /(?<![\w./-])[a-z]+(?:_[a-z]+)+(?![\w/-])(?!\.\w)/g;

// a sentence of the lab in the words and signs of the page: names such as viscous_asymmetry are words here
export function spoken(text) {
  return text.replace(MADE_FOR_PROGRAMS, nameOf).replace(/\bvelocity\b/g, "speed").replace(/(\d)%/g, "$1 %").replace(/(\d(?: %)?) \.\. (?=[-−\d])/g, "$1 to ").replaceAll("<=", "≤");
}

// a time as people say it
export function duration(time_s) {
  if (time_s < 90) return `${number(Math.round(time_s))} s`;
  return time_s < 5400 ? `${number(Math.round(time_s / 60))} min` : `${number(time_s / 3600, 2)} h`;
}

export function conditions(values) {
  return Object.entries(values ?? {}).map(([name, value]) => {
    if (value === true) return nameOf(name);
    if (value === false) return `not ${nameOf(name)}`;
    return `${nameOf(name)} ${quantity(name, value)}`;
  }).join(", ");
}

export function when(iso) {
  if (!iso) return "–";
  const date = new Date(iso);
  if (Number.isNaN(date.getTime())) return String(iso);
  const two = (value) => String(value).padStart(2, "0");
  const day = [date.getFullYear(), two(date.getMonth() + 1), two(date.getDate())].join("-");
  return `${day} ${[date.getHours(), date.getMinutes(), date.getSeconds()].map(two).join(":")}`;
}

const LEAST_P = 0.001; // stands for that and less: no smaller chance can be known

// of a table whose heading says p
export function chanceCell(p) {
  if (p === null || p === undefined) return "–";
  return p <= LEAST_P ? `≤ ${LEAST_P}` : number(p, 2);
}
