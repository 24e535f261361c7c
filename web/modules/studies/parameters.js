// The parameters of a model with their units and intervals, and what it does at rest and at breakaway.

import { h, table } from "../ui/dom.js";
import { chanceCell, fixed, interval, number, percent } from "../ui/format.js";

const FEW = 3;
const MOST_PLACES = 8;

// the column that says which it is, and of which effect
export const PARAMETER = { title: "Parameter", cell: (one) => [one.name.replaceAll("_", " "), h("div", { class: "hint" }, one.effect.replaceAll("_", " "))] };

export function parameterTables(compared) {
  return [parameterTable(compared), ...breakawayTable(compared), ...restTable(compared)];
}

function restTable({ at_rest: atRest, effort }) {
  if (!atRest) return [];
  return [table(`At rest, ${atRest.stretches} stretches of 0.1 s: beyond what friction holds`, [
    { title: "Side", cell: (one) => one.side },
    { title: "Outside", number: true, cell: (one) => percent(one.outside) },
    { title: `Largest [${effort.unit}]`, number: true, cell: (one) => number(one.largest, 3) },
    { title: "p", number: true, cell: (one) => chanceCell(one.p_value) },
    { title: "Clearest in", cell: (one) => one.trial },
  ], atRest.sides), h("p", { class: "soft" }, atRest.sentence)];
}

function breakawayTable({ breakaway }) {
  if (!breakaway) return [];
  const errors = `error ${percent(breakaway.training.relative)}, held out ${percent(breakaway.held_out.relative)}`;
  return [parameterTable(breakaway, `Breakaway: ${breakaway.starts} starts from rest, ${errors}`)];
}

function parameterTable({ parameters }, title = "Parameters") {
  return table(title, [
    PARAMETER,
    { title: "Value (95 %)", number: true, cell: (one) => written(one) },
    { title: "Unit", cell: (one) => unitText(one.unit) },
    { title: "Note", cell: (one) => one.note },
  ], parameters);
}

// to the place that the interval leaves to be read: the first digit of half its width, and one more where that is small
export function written(one) {
  return interval(one.value, one.low, one.high, writerOf(one));
}

// what writes the value, and the ends of its interval
export function writerOf({ low, high }) {
  const half = (high - low) / 2;
  const places = Math.ceil(-Math.log10(half)) + (firstDigit(half) < FEW ? 1 : 0);
  return half > 0 && places <= MOST_PLACES ? (one) => fixed(one, Math.max(0, places)) : (one) => number(one, 3);
}

function firstDigit(value) {
  return Number(value.toExponential(0)[0]);
}

// "N m s2/rad" -> "N m s²/rad"
export function unitText(unit) {
  return unit.replace(/(?<=[a-z])2/g, "²").replace(/^1$/, "");
}
