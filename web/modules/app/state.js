// What the bench does, told once: badge, message about STOP and age of the readings all follow from this state.

import { get } from "./api.js";

const STALE_MS = 2000;
const SHOWN_MS = 10_000; // a confirmed stop

export class BenchState extends EventTarget {
  #stop = null;
  #read = { key: "", at_ms: null };

  constructor(live) {
    super();
    this.live = live;
    for (const name of ["status", "tick"]) live.addEventListener(name, () => this.#changed());
  }

  // what became of a press on STOP: {phase, text, experiment_id}; see stop.js
  set stop(told) {
    this.#stop = told && { ...told, at_ms: performance.now() };
    this.#changed();
  }

  get stop() {
    return this.#stop;
  }

  get now() {
    const now_ms = performance.now();
    const { status, heard_ms, retry_ms } = this.live;
    // the first that is heard need not be the status: nothing is known until that has come
    const fresh = status !== null && now_ms - heard_ms <= STALE_MS;
    return {
      status, fresh, running: fresh && status?.state === "running", silent_s: (now_ms - heard_ms) / 1000, retry_s: Math.max(0, retry_ms - now_ms) / 1000,
      message: messageOf(this.#stop, { status, fresh, heard_ms, now_ms }),
      reading_age_s: this.#read.at_ms === null ? null : (now_ms - this.#read.at_ms) / 1000,
    };
  }

  #changed() {
    this.#age();
    this.dispatchEvent(new Event("change"));
  }

  // when the last reading was taken. A page that is opened later asks when the experiment ended
  #age() {
    const { status } = this.live;
    if (!status?.run) return;
    const { experiment_id, trial_index } = status.run;
    const key = `${experiment_id} ${trial_index} ${status.reading?.time_s}`;
    if (key === this.#read.key) return;
    const first = this.#read.key === "";
    this.#read = { key, at_ms: first && status.state === "idle" ? null : performance.now() };
    if (this.#read.at_ms === null) this.#askWhen(experiment_id, key);
  }

  async #askWhen(experiment_id, key) {
    const found = await get(`/experiments/${experiment_id}`).catch(() => null);
    if (found?.finished_utc && this.#read.key === key) this.#read.at_ms = performance.now() - (Date.now() - new Date(found.finished_utc).getTime());
    this.dispatchEvent(new Event("change"));
  }
}

// what is still true of a press on STOP; null where nothing is to be said. Pure.
export function messageOf(stop, { status, fresh, heard_ms, now_ms }) {
  if (!stop) return null;
  const newer = fresh && heard_ms > stop.at_ms;
  const run = status?.run;
  const another = stop.experiment_id !== undefined && run?.experiment_id != null && run.experiment_id !== stop.experiment_id;
  if (newer && status.state === "running" && another) return null;
  if (stop.phase === "confirmed") return now_ms - stop.at_ms > SHOWN_MS ? null : stop;
  const over = newer && status.state === "idle" && run?.power_off !== "failed";
  return stop.phase !== "asking" && over ? null : stop;
}

// how a reading is shown: {dimmed, words}. Pure.
export function readingNote({ status, fresh, running, silent_s, reading_age_s: age_s }) {
  if (!status?.reading) return { dimmed: false, words: "" };
  if (!fresh) return { dimmed: true, words: `Old: no news from the service for ${Math.round(silent_s)} s.` };
  if (running) return { dimmed: false, words: "" };
  const since = age_s === null ? "" : `, ${ago(age_s)}`;
  if (!poweredOff({ status, fresh, running })) return { dimmed: true, words: `Last reading${since}. The drive may still have power.` };
  return { dimmed: true, words: `The drive is off. These are the readings of the last cycle before that${since}; since then nothing is measured.` };
}

// whether the run has ended with its power off: no reading comes after that one. Pure.
export function poweredOff({ status, fresh, running }) {
  return Boolean(fresh && !running && status?.reading && status.run?.power_off !== "failed");
}

export function ago(age_s) {
  if (age_s < 1.5) return "a moment ago";
  if (age_s < 100) return `${Math.round(age_s)} s ago`;
  return age_s < 6000 ? `${Math.round(age_s / 60)} min ago` : `${Math.round(age_s / 3600)} h ago`;
}
