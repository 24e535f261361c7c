// Units as people read them, degrees and grams, or SI as everything is kept; one switch for the whole page.

import { h, replace } from "./dom.js";

const KEY = "friction-bench-units";
const DEGREES = 180 / Math.PI;
const FOR_PEOPLE = { rad: ["°", DEGREES], "rad/s": ["°/s", DEGREES], "rad/s²": ["°/s²", DEGREES], kg: ["g", 1000] };
const WRITTEN = { degC: "°C", "rad/s2": "rad/s²", "m/s2": "m/s²" };

export function inSi() {
  return localStorage.getItem(KEY) === "SI";
}

// SI unit -> {unit, factor}: as it is shown, and what a value in SI is multiplied by
export function shownUnit(si) {
  const written = WRITTEN[si] ?? si;
  const [unit, factor] = (!inSi() && FOR_PEOPLE[written]) || [written, 1];
  return { unit, factor };
}

// what an axis, a column or a field is called, with the unit that is shown: "load [g]"
export function titled(text, si) {
  const { unit } = shownUnit(si);
  return unit ? `${text} [${unit}]` : text;
}

// values as they are shown: the same where nothing is to be converted, a copy where it is
export function allShown(values, si) {
  const { factor } = shownUnit(si);
  return factor === 1 ? values : values.map((value) => factor * value);
}

// a value without the noise of its conversion: 1.57079632679 rad are 90°, not 89.99999999
export function toShown(value, si, digits = 6) {
  const { factor } = shownUnit(si);
  return factor === 1 ? value : Number((value * factor).toPrecision(digits));
}

export function toSi(value, si) {
  const { factor } = shownUnit(si);
  return factor === 1 ? value : Number((value / factor).toPrecision(12));
}

// "90°", "100 g", "0.5 rad"
export function withShownUnit(value, si, digits = 4) {
  const { unit } = shownUnit(si);
  const text = String(Number(toShown(value, si).toPrecision(digits))).replace("-", "−");
  return unit === "°" || unit === "°/s" ? `${text}${unit}` : `${text}${unit ? ` ${unit}` : ""}`;
}

// an effort that is small: its unit, or a thousandth of it, so that no row of noughts stands before the digits
export function milli(highest, unit) {
  return highest > 0 && highest < 0.1 ? { unit: `m${unit}`, factor: 1000 } : { unit, factor: 1 };
}

// changed(): everything that is shown has to be drawn again
export function unitSwitch(place, changed) {
  const button = h("button", { type: "button", class: "small", title: "Units: degrees and grams, or SI", "aria-label": "Units: degrees and grams, or SI", onclick: () => {
    localStorage.setItem(KEY, inSi() ? "people" : "SI");
    button.textContent = words();
    changed();
  } }, words());
  replace(place, button);
}

function words() {
  return inSi() ? "SI" : "° g";
}
