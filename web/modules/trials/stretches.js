// The samples of one trial at several resolutions: all of it, and the stretches that were looked at closer. The service
// thins what it sends, so a shorter stretch of as many points shows more; the finest that covers a view is drawn.

import { get } from "../app/api.js";
import { firstFrom } from "../plots/thin.js";

const POINTS = 4000; // of the whole trial; the extremes of each channel are among them
const CLOSER_POINTS = 9000; // of a stretch: of a view and as much on both sides, so that it can be moved at once
const KEPT = 8;
const WIDE = 2; // times as wide as the view: from there on the whole trial is too coarse,
const WIDE_CLOSER = 3.2; // and a stretch, which is read three times as wide

const numbers = (values) => Float64Array.from(values, (value) => value ?? NaN);
const covers = (one, [from, to], [low, high]) => one.from <= Math.max(from, low) && one.to >= Math.min(to, high);

// where nothing was recorded, a row of which nothing is known: no line is drawn from one side to the other
export function interrupted({ channels, gaps = [] }) {
  const { time_s } = channels;
  const inside = gaps.filter(({ from_s, to_s }) => from_s >= time_s[0] && to_s <= time_s.at(-1));
  if (!inside.length) return channels;
  const whole = Object.fromEntries(Object.entries(channels).map(([name, values]) => [name, [...values]]));
  for (const { from_s, to_s } of inside) {
    const middle = (from_s + to_s) / 2;
    const at = firstFrom(whole.time_s, middle);
    for (const [name, values] of Object.entries(whole)) values.splice(at, 0, name === "time_s" ? middle : null);
  }
  return whole;
}

export class Stretches {
  #kept = []; // {from, to, whole, channels}; the newest last, the whole trial first

  constructor(trial_id, channels) {
    Object.assign(this, { trial_id, channels });
  }

  // [first, last] time; [0, 1] where there are no rows
  get limits() {
    const { time_s } = this.#kept[0].channels;
    return time_s.length ? [time_s[0], time_s.at(-1)] : [0, 1];
  }

  async open(signal) {
    this.#kept = [await this.#read({ points: POINTS }, signal)];
  }

  best(view) {
    return this.#finest(view).channels;
  }

  // reads a view closer; false where what is there is as fine already
  async refine([from, to], signal) {
    const known = this.#finest([from, to]);
    const size = to - from;
    const wide = known === this.#kept[0] ? WIDE : WIDE_CLOSER;
    if (known.complete || known.to - known.from <= wide * size) return false;
    const read = await this.#read({ points: CLOSER_POINTS, from_s: from - size, to_s: to + size }, signal);
    this.#kept.push(read);
    if (this.#kept.length > KEPT) this.#kept.splice(1, 1);
    return true;
  }

  #finest(view) {
    const covering = this.#kept.filter((one) => covers(one, view, this.limits));
    return covering.reduce((best, one) => (one.to - one.from < best.to - best.from ? one : best), this.#kept[0]);
  }

  async #read({ points, from_s, to_s }, signal) {
    const answer = await get(`/trials/${this.trial_id}/samples`, { channels: this.channels.join(","), points, from_s, to_s }, { signal });
    const channels = Object.fromEntries(Object.entries(interrupted(answer)).map(([name, values]) => [name, numbers(values)]));
    // so few were asked for, or are there, that none was left out: nothing finer can be had
    const complete = answer.rows_returned >= answer.rows_recorded || answer.rows_returned < points / (2 * this.channels.length);
    return { channels, complete, from: from_s ?? channels.time_s[0] ?? 0, to: to_s ?? channels.time_s.at(-1) ?? 1 };
  }
}
