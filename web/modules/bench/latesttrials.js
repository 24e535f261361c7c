// The trials of the experiment that runs, as they come: events of the newest, results of those that have ended.

import { get } from "../app/api.js";

const EVERY_MS = 700;
const MOST = 200;

export class LatestTrials extends EventTarget {
  trials = [];
  events = [];
  #experiment = null;
  #trial = null;
  #settled = "";

  constructor(live) {
    super();
    this.live = live;
    this.timer = setInterval(() => this.#refresh(), EVERY_MS);
    this.#refresh();
  }

  close() {
    clearInterval(this.timer);
  }

  async #refresh() {
    const run = this.live.status?.run;
    if (!run?.experiment_id || this.busy || document.hidden) return;
    const key = `${run.experiment_id} ${run.outcome} ${run.trial_index}`;
    if (run.outcome !== "running" && key === this.#settled) return;
    this.busy = true;
    try {
      await this.#read(run);
      this.#settled = key;
      this.dispatchEvent(new Event("change"));
    } catch {
      // the next round tries again; that the service is gone is said in the bar above
    } finally {
      this.busy = false;
    }
  }

  async #read(run) {
    if (run.experiment_id !== this.#experiment) Object.assign(this, { trials: [], events: [] });
    this.#experiment = run.experiment_id;
    const offset = Math.max(0, run.trial_index + 1 - MOST);
    this.trials = (await get("/trials", { experiment_id: run.experiment_id, offset, limit: MOST })).items;
    this.#trial = this.trials.at(-1)?.trial_id ?? null;
    this.events = this.#trial === null ? [] : (await get(`/trials/${this.#trial}`)).events;
  }
}
