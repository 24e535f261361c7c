// Trials chosen by what they have in common: kind, conditions, name. Criteria of the service: key=value[,value ...].

import { h, replace } from "../ui/dom.js";
import { nameOf, quantity } from "../ui/format.js";

const MOST_VALUES = 60;
const OPEN = 12;

export const used = { legend: "Trials that are used", summary: "all; leave some out", checked: true, kind: true };
export const heldOut = { legend: "Held out of the fit, to judge it (by condition; none: each trial is left out in turn)", checked: false };

// what trials differ in: [[key, values]]; those that every trial shares are left out
export function groupsOf(trials, { kind = false } = {}) {
  const keys = [...new Set(trials.flatMap((trial) => Object.keys(trial.conditions)))];
  const groups = keys.map((key) => [key, [...new Set(trials.map((trial) => trial.conditions[key]).filter((value) => value !== undefined))]]);
  if (kind) groups.unshift(["kind", [...new Set(trials.map((trial) => trial.kind))]]);
  const differing = groups.filter(([, values]) => values.length > 1 && values.length <= MOST_VALUES);
  return trials.length > 1 && trials.length <= MOST_VALUES ? [...differing, ["trial", [...new Set(trials.map((trial) => trial.name))]]] : differing;
}

export class TrialChoice {
  #groups = [];

  constructor(look) {
    this.look = look;
    this.element = h("div");
  }

  show(trials) {
    this.#groups = groupsOf(trials, this.look).map(([key, values]) => ({ key, boxes: values.map((value) => this.#box(key, value)) }));
    replace(this.element, trials.length > 0 && this.#fields());
  }

  // one criterion for each that is checked: a trial that meets any of them is meant
  chosen() {
    return this.#groups.flatMap(({ boxes }) => boxes.filter(({ input }) => input.checked).map(({ input }) => input.value));
  }

  // one criterion for each key of which something was left out: a trial has to meet all of them
  unlessAll() {
    const narrowed = this.#groups.filter(({ boxes }) => !boxes.every(({ input }) => input.checked));
    return narrowed.map(({ key, boxes }) => `${key}=${boxes.filter(({ input }) => input.checked).map(({ value }) => value).join(",")}`);
  }

  #box(key, value) {
    const input = h("input", { type: "checkbox", value: `${key}=${value}`, checked: this.look.checked });
    return { input, value, label: h("label", { class: "inline" }, input, quantity(key, value)) };
  }

  #fields() {
    if (!this.#groups.length) return this.look.checked ? null : h("p", { class: "soft" }, "One trial only: nothing can be held out.");
    const groups = this.#groups.map(({ key, boxes }) => h("details", { open: !this.look.checked && key !== "trial" && boxes.length <= OPEN },
      h("summary", {}, nameOf(key)), h("div", { class: "row centre" }, boxes.map(({ label }) => label))));
    const { legend, summary } = this.look;
    return h("fieldset", {}, h("legend", {}, legend), summary ? h("details", {}, h("summary", {}, summary), groups) : groups);
  }
}
