// The live stream: status and rows as they are recorded. Reconnects by itself; keeps a bounded window of rows.

import { events } from "./api.js";

const WINDOW_ROWS = 20_000;
const RETRY_MS = 1000;
const STALE_MS = 2000;

export class Live extends EventTarget {
  status = null;
  channels = [];
  rows = [];
  #after = -1;
  #heard = -Infinity;

  get stale() {
    return performance.now() - this.#heard > STALE_MS;
  }

  async run() {
    setInterval(() => this.#tell("tick"), 500);
    for (;;) {
      try {
        for await (const message of events(`/live?after_row=${this.#after}`)) this.#receive(message);
      } catch {
        this.#tell("tick");
      }
      await new Promise((resolve) => setTimeout(resolve, RETRY_MS));
    }
  }

  column(name) {
    const index = this.channels.indexOf(name);
    return index < 0 ? null : this.rows.map((row) => row[index]);
  }

  #receive({ event, data }) {
    this.#heard = performance.now();
    if (event === "status") this.status = data;
    if (event === "rows") this.#append(data);
    this.#tell(event);
  }

  #append(data) {
    if (data.restarted) this.rows = [];
    this.channels = data.channels;
    this.rows.push(...data.rows);
    this.#after = data.last_row;
    if (this.rows.length > 1.5 * WINDOW_ROWS) this.rows = this.rows.slice(-WINDOW_ROWS);
  }

  #tell(name) {
    this.dispatchEvent(new Event(name));
  }
}
