// The live stream: status and rows as they are recorded. Reconnects by itself; keeps a bounded window of rows.

import { events } from "./api.js";
import { Ring } from "../bench/ring.js";

const WINDOW_ROWS = 20_000; // as many as the service keeps: a page that is opened late sees what went before
const RETRY_MS = 1000;
const STALE_MS = 2000;

export class Live extends EventTarget {
  status = null;
  rows = new Ring([], 0);
  #after = -1;
  #heard = -Infinity;
  #connection = null;

  get stale() {
    return performance.now() - this.#heard > STALE_MS;
  }

  async run() {
    setInterval(() => this.#tell("tick"), 500);
    // a page in the background gives its connection back: browsers have few of them, and STOP of another page needs one
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.#connection?.abort(); });
    for (;;) {
      await visible();
      this.#connection = new AbortController();
      try {
        const stream = events(`/live?after_row=${this.#after}&limit=${WINDOW_ROWS}`, this.#connection.signal);
        for await (const message of stream) this.#receive(message);
      } catch {
        this.#tell("tick");
      }
      if (!document.hidden) await new Promise((resolve) => setTimeout(resolve, RETRY_MS));
    }
  }

  #receive({ event, data }) {
    this.#heard = performance.now();
    if (event === "status") this.status = data;
    if (event === "rows") this.#append(data);
    this.#tell(event);
  }

  #append(data) {
    if (data.channels.join() !== this.rows.channels.join()) this.rows = new Ring(data.channels, WINDOW_ROWS);
    if (data.restarted) this.rows.clear();
    this.rows.append(data.rows);
    this.#after = data.last_row;
  }

  #tell(name) {
    this.dispatchEvent(new Event(name));
  }
}

function visible() {
  if (!document.hidden) return Promise.resolve();
  return new Promise((resolve) => {
    const shown = () => {
      if (document.hidden) return;
      document.removeEventListener("visibilitychange", shown);
      resolve();
    };
    document.addEventListener("visibilitychange", shown);
  });
}
