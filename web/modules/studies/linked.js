// One cursor for all plots of a study. Pointed at a time in the trial that is shown, it stands at that time, and at what
// drives the residual then, in all others; pointed at over a driver, the times when the joint was there are shaded.

import { get } from "../app/api.js";
import { firstFrom } from "../plots/thin.js";
import { allShown } from "../ui/units.js";

const NEAR = 0.02; // of what a driver's plot spans, on both sides of the pointer

export class Linked {
  #known = new Map(); // trial -> promise of its drivers over time
  #over = []; // plots over a driver: {chart, name}
  #timed = []; // plots over time: {chart, trial_id()}
  #told = [];

  // series: the plot over time that is always there
  constructor(path, series) {
    Object.assign(this, { path, series });
    series.chart.addEventListener("cursor", () => this.#at(series.chart.cursor, series.chart));
  }

  // name: of the driver, or its title: answers of the service have either
  over(chart, name) {
    this.#over.push({ chart, name });
    chart.addEventListener("cursor", async () => {
      const x = chart.cursor;
      const [low, high] = chart.limits;
      const near = NEAR * (high - low);
      const source = x === null ? null : await this.#drivers();
      if (x !== chart.cursor) return;
      const driver = named(source, name);
      this.series.brush(driver ? stretches(source.time_s, allShown(driver.values, driver.unit).map((value) => Math.abs(value - x) <= near)) : []);
    });
  }

  // trial_id(): the trial that is shown there
  timed(chart, trial_id) {
    this.#timed.push({ chart, trial_id });
    chart.addEventListener("cursor", () => {
      if (trial_id() !== this.series.trial_id) return;
      this.series.chart.cursor = chart.cursor;
      this.#at(chart.cursor, chart);
    });
  }

  // told(values): where the joint is at the cursor, driver -> value in SI; null where there is none
  tell(told) {
    this.#told.push(told);
  }

  // where: driver -> [low, high] in SI; shades when all of them held; null shades nothing
  async shade(where) {
    this.wanted = where;
    const source = where && (await this.#drivers());
    if (this.wanted !== where) return;
    const values = new Map(source?.drivers.map((one) => [one.driver, one.values]));
    const inside = source?.time_s.map((_, at) => Object.entries(where).every(([name, [low, high]]) => values.get(name)?.[at] >= low && values.get(name)[at] <= high));
    this.series.brush(source ? stretches(source.time_s, inside) : []);
  }

  close() {
    for (const { chart } of [...this.#over, ...this.#timed]) chart.close();
    this.series.close();
  }

  async #at(time_s, from) {
    const source = time_s === null ? null : await this.#drivers();
    if (source && time_s !== from.cursor) return;
    const index = source && Math.min(firstFrom(source.time_s, time_s), source.time_s.length - 1);
    for (const { chart, name } of this.#over) {
      const driver = named(source, name);
      chart.cursor = driver ? allShown(driver.values, driver.unit)[index] : null;
    }
    for (const { chart, trial_id } of this.#timed) if (chart !== from) chart.cursor = trial_id() === this.series.trial_id ? time_s : null;
    const values = source && Object.fromEntries(source.drivers.map((one) => [one.driver, one.values[index]]));
    for (const told of this.#told) told(values);
  }

  #drivers() {
    const { trial_id } = this.series;
    if (!this.#known.has(trial_id)) this.#known.set(trial_id, get(`${this.path}/drivers`, { trial_id }).catch(() => null));
    return this.#known.get(trial_id);
  }
}

function named(source, name) {
  return source?.drivers.find((one) => one.driver === name || one.title === name);
}

// where it is true: [{from, to}] in the time of rising time_s
export function stretches(time_s, inside) {
  const found = [];
  for (let at = 0; at < inside.length; at += 1) {
    if (!inside[at]) continue;
    if (at > 0 && inside[at - 1]) found.at(-1).to = time_s[at];
    else found.push({ from: time_s[at], to: time_s[at] });
  }
  return found;
}
