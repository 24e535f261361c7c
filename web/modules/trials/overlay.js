// Several trials in one plot: any channels over time, refined where one looks closer, or over any other channel.

import { attempt } from "../ui/attempt.js";
import { Chart } from "../plots/chart.js";
import { h, replace } from "../ui/dom.js";
import { axisTitle, nameOf, unitOf, withUnit } from "../ui/format.js";
import { around, HALF, LOAD } from "../bench/load.js";
import { marksOf } from "../plots/marks.js";
import { colour, SERIES } from "../ui/colours.js";
import { draw, forget } from "../plots/plotly.js";
import { firstFrom } from "../plots/thin.js";
import { shownUnit } from "../ui/units.js";
import { Stretches } from "./stretches.js";

const SETTLED_MS = 150;
const OF_THE_JOINT = ["position_rad", "target_rad", "current_a", "current_estimate_a"]; // that its drawing needs
const DASHES = [undefined, [6, 4], [2, 3], [9, 3, 2, 3]];

// the load's share of the current that the search found, with its 95 % interval, from when it was found
export function loadFound(trial, end_s, row) {
  const { load_current_a: current_a, load_interval_a: interval } = trial.results ?? {};
  const found = marksOf(trial.events).findLast((mark) => mark.kind === "estimate");
  if (typeof current_a !== "number" || !interval || !found) return null;
  const x = [found.x, end_s];
  const level = (value) => [value, value];
  return { line: { row, name: "load (band: 95 %)", x, y: level(current_a), colour: "sky", width: 3 },
    band: { row, x, low: level(interval[0]), high: level(interval[1]), colour: "sky" } };
}

function scaled(values, si) {
  const { factor } = shownUnit(si);
  return factor === 1 ? values : values.map((value) => factor * value);
}

export class Overlay {
  #stretches = new Map(); // trial -> Stretches
  #shown = []; // what is drawn of each trial
  #timer = null;
  #asked = new AbortController(); // what was asked for what is not looked at any more is given up

  // trials: as GET /trials/{id} answers, events and all
  constructor(place, trials) {
    this.trials = trials;
    this.answer = h("div");
    this.time = h("div");
    this.across = h("div", { class: "plot", role: "figure", "aria-label": "One channel against another", hidden: true });
    replace(place, this.answer, this.time, this.across);
    this.chart = new Chart(this.time, { label: `Channels of trial ${trials.map((trial) => trial.trial_id).join(", ")} over time`, height: 460 });
    this.chart.addEventListener("view", () => {
      this.#drawBest();
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#lookCloser(), SETTLED_MS);
    });
  }

  async show(channels, against) {
    Object.assign(this, { channels, against });
    const signal = this.#only();
    await attempt(this.answer, async () => {
      const wanted = new Map(this.trials.map((trial) => [trial.trial_id, new Stretches(trial.trial_id, this.#channelsOf(trial))]));
      await Promise.all([...wanted.values()].map((one) => one.open(signal)));
      this.#stretches = wanted;
      this.#shown = [];
      this.time.hidden = against !== "time_s";
      this.across.hidden = !this.time.hidden;
      if (this.time.hidden) await this.#drawAcross();
      else this.#drawBest();
    });
  }

  // first and last time of all trials [s]
  get limits() {
    return this.#limits();
  }

  // what the joint of the first trial did at a time; NaN where it was not measured
  at(time_s) {
    const source = this.#stretches.get(this.trials[0].trial_id)?.best(this.chart.view) ?? {};
    const index = Math.min(firstFrom(source.time_s ?? [], time_s), (source.time_s?.length ?? 1) - 1);
    const value = (name) => source[name]?.[index] ?? NaN;
    return { position_rad: value("position_rad"), target_rad: value("target_rad"), current_a: Number.isFinite(value("current_a")) ? value("current_a") : value("current_estimate_a") };
  }

  close() {
    clearTimeout(this.#timer);
    this.#asked.abort();
    this.chart.close();
    forget(this.across);
  }

  #only() {
    this.#asked.abort();
    this.#asked = new AbortController();
    return this.#asked.signal;
  }

  #channelsOf(trial) {
    const band = this.channels.includes(LOAD) ? [HALF] : [];
    return [...new Set(["time_s", this.against, ...this.channels, ...band, ...OF_THE_JOINT])].filter((name) => trial.channels.includes(name));
  }

  async #lookCloser() {
    const signal = this.#only();
    await attempt(this.answer, async () => {
      const found = await Promise.all([...this.#stretches.values()].map((one) => one.refine(this.chart.view, signal)));
      if (found.includes(true)) this.#drawBest();
    });
  }

  // only where something finer, or something that reaches further, has come: the chart moves what it has by itself
  #drawBest() {
    if (!this.#stretches.size) return;
    const limits = this.#limits();
    const view = this.#shown.length ? this.chart.view : limits;
    const best = this.trials.map((trial) => this.#stretches.get(trial.trial_id).best(view));
    if (best.length === this.#shown.length && best.every((one, at) => one === this.#shown[at])) return;
    this.#shown = best;
    this.#drawTime(best, limits);
  }

  #limits() {
    const all = [...this.#stretches.values()].map((one) => one.limits);
    return [Math.min(...all.map(([low]) => low)), Math.max(...all.map(([, high]) => high))];
  }

  #drawTime(sources, limits) {
    const units = [...new Set(this.channels.map(unitOf))];
    const several = this.trials.length > 1;
    const lines = this.trials.flatMap((trial, index) => {
      const source = sources[index];
      return this.channels.filter((name) => source[name]?.some(Number.isFinite)).map((name) => {
        const at = this.channels.indexOf(name);
        return { row: units.indexOf(unitOf(name)), name: several ? `${trial.trial_id} ${nameOf(name)}` : nameOf(name), x: source.time_s, y: scaled(source[name], unitOf(name)), half: name === LOAD ? source[HALF] : null,
          colour: SERIES[(several ? index : at) % SERIES.length], dash: several ? DASHES[at % DASHES.length] : undefined };
      });
    });
    const load = several || !units.includes("A") ? null : loadFound(this.trials[0], limits[1], units.indexOf("A"));
    if (load) lines.push(load.line);
    const bands = load ? [load.band] : [];
    for (const line of lines.filter((one) => one.half)) bands.push(around(line.row, line.x, line.y, line.half, line.colour));
    this.chart.show({ rows: units.map((unit) => ({ title: axisTitle(unit) })), lines, limits, bands, xTitle: "time in the trial [s]",
      marks: several ? [] : marksOf(this.trials[0].events).filter((mark) => mark.letter) });
  }

  #drawAcross() {
    const traces = this.trials.flatMap((trial, index) => {
      const source = this.#stretches.get(trial.trial_id).best([-Infinity, Infinity]);
      if (!source[this.against]) return [];
      return this.channels.filter((name) => source[name]).map((name, at) => ({ x: [...scaled(source[this.against], unitOf(this.against))], y: [...scaled(source[name], unitOf(name))], mode: "markers", showlegend: true,
        name: this.trials.length > 1 ? `${trial.trial_id} ${nameOf(name)}` : withUnit(name), marker: { size: 3, color: colour(SERIES[(index + at) % SERIES.length]) } }));
    });
    return draw(this.across, traces, { height: 460, xaxis: { title: { text: withUnit(this.against) } }, uirevision: this.against });
  }
}
