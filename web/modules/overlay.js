// Several trials in one plot: any channels over time, refined where one looks closer, or over any other channel.

import { get } from "./api.js";
import { Chart } from "./chart.js";
import { h, replace } from "./dom.js";
import { unitOf, nameOf, withUnit } from "./format.js";
import { marksOf } from "./marks.js";
import { SERIES, colour, draw, forget } from "./plot.js";
import { attempt } from "./problem.js";

const POINTS = 4000; // of each trial; the extremes are among them
const SETTLED_MS = 150;
const DASHES = [undefined, [6, 4], [2, 3], [9, 3, 2, 3]];
const numbers = (values) => Float64Array.from(values, (value) => value ?? NaN);

export class Overlay {
  #samples = new Map(); // trial -> channels of all of it
  #closer = new Map(); // trial -> channels of what is looked at
  #timer = null;

  // trials: as GET /trials/{id} answers, events and all
  constructor(place, trials) {
    this.trials = trials;
    this.answer = h("div");
    this.time = h("div");
    this.across = h("div", { class: "plot", role: "figure", "aria-label": "One channel against another", hidden: true });
    replace(place, this.answer, this.time, this.across);
    this.chart = new Chart(this.time, { label: `Channels of trial ${trials.map((trial) => trial.trial_id).join(", ")} over time`, height: 460 });
    this.chart.addEventListener("view", () => {
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#lookCloser(), SETTLED_MS);
    });
  }

  async show(channels, against) {
    Object.assign(this, { channels, against });
    await attempt(this.answer, async () => {
      this.#closer.clear();
      for (const trial of this.trials) this.#samples.set(trial.trial_id, await this.#read(trial, {}));
      this.time.hidden = against !== "time_s";
      this.across.hidden = !this.time.hidden;
      if (this.time.hidden) await this.#drawAcross();
      else this.#drawTime();
    });
  }

  close() {
    clearTimeout(this.#timer);
    this.chart.close();
    forget(this.across);
  }

  async #read(trial, stretch) {
    const wanted = [...new Set(["time_s", this.against, ...this.channels])].filter((name) => trial.channels.includes(name));
    const { channels } = await get(`/trials/${trial.trial_id}/samples`, { channels: wanted.join(","), points: POINTS, ...stretch });
    return Object.fromEntries(Object.entries(channels).map(([name, values]) => [name, numbers(values)]));
  }

  // what was thinned for all of the trial is read again for the stretch that is shown
  async #lookCloser() {
    const [from_s, to_s] = this.chart.view;
    const margin = (to_s - from_s) / 2;
    await attempt(this.answer, async () => {
      for (const trial of this.trials) {
        if (trial.rows > POINTS / 4) this.#closer.set(trial.trial_id, await this.#read(trial, { from_s: from_s - margin, to_s: to_s + margin }));
      }
      this.#drawTime();
    });
  }

  #drawTime() {
    const units = [...new Set(this.channels.map(unitOf))];
    const several = this.trials.length > 1;
    const lines = this.trials.flatMap((trial, index) => {
      const source = this.#closer.get(trial.trial_id) ?? this.#samples.get(trial.trial_id);
      return this.channels.filter((name) => source[name]?.some(Number.isFinite)).map((name) => {
        const at = this.channels.indexOf(name);
        return { row: units.indexOf(unitOf(name)), name: several ? `${trial.trial_id} ${nameOf(name)}` : nameOf(name), x: source.time_s, y: source[name],
          colour: SERIES[(several ? index : at) % SERIES.length], dash: several ? DASHES[at % DASHES.length] : undefined };
      });
    });
    const all = [...this.#samples.values()];
    const limits = [Math.min(...all.map((one) => one.time_s[0] ?? 0)), Math.max(...all.map((one) => one.time_s.at(-1) ?? 1))];
    this.chart.show({ rows: units.map((title) => ({ title })), lines, limits, xTitle: "time in the trial [s]",
      marks: several ? [] : marksOf(this.trials[0].events).filter((mark) => mark.letter) });
  }

  #drawAcross() {
    const traces = this.trials.flatMap((trial, index) => {
      const source = this.#samples.get(trial.trial_id);
      if (!source[this.against]) return [];
      return this.channels.filter((name) => source[name]).map((name, at) => ({ x: [...source[this.against]], y: [...source[name]], mode: "markers", showlegend: true,
        name: this.trials.length > 1 ? `${trial.trial_id} ${nameOf(name)}` : withUnit(name), marker: { size: 3, color: colour(SERIES[(index + at) % SERIES.length]) } }));
    });
    return draw(this.across, traces, { height: 460, xaxis: { title: { text: withUnit(this.against) } }, uirevision: this.against });
  }
}
