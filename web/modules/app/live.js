// The live stream: status and rows as they are recorded. Reconnects by itself; keeps a bounded window of rows.

import { events } from "./api.js";
import { Ring } from "../bench/ring.js";
import { Pour } from "./pour.js";

const WINDOW_ROWS = 20_000; // as many as the service keeps: a page that is opened late sees what went before
const RETRY_MS = 1000; // doubled with each try that fails,
const LONGEST_RETRY_MS = 8000; // up to this

export class Live extends EventTarget {
  status = null;
  rows = new Ring([], 0);
  heard_ms = -Infinity; // when the service was last heard
  retry_ms = 0; // when it is asked again
  #after = -1;
  #wait_ms = RETRY_MS;
  #connection = null;
  #pour = new Pour((rows) => {
    this.rows.append(rows);
    this.#tell("rows");
  });

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
      if (!document.hidden) await this.#pause();
    }
  }

  // a service that is gone is asked ever more seldom, and at once when the network comes back
  async #pause() {
    this.retry_ms = performance.now() + this.#wait_ms;
    await new Promise((resolve) => {
      const timer = setTimeout(resolve, this.#wait_ms);
      addEventListener("online", () => { clearTimeout(timer); resolve(); }, { once: true });
    });
    this.#wait_ms = Math.min(2 * this.#wait_ms, LONGEST_RETRY_MS);
  }

  #receive({ event, data }) {
    this.heard_ms = performance.now();
    this.#wait_ms = RETRY_MS;
    if (event === "status") this.status = data;
    if (event === "rows") this.#append(data);
    else this.#tell(event);
  }

  #append(data) {
    const others = data.channels.join() !== this.rows.channels.join();
    if (others || data.restarted) this.#pour.empty();
    if (others) this.rows = new Ring(data.channels, WINDOW_ROWS);
    if (data.restarted) this.rows.clear();
    this.#pour.add(data.rows);
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
