// Rows arrive in blocks, some twenty a second; they are handed on evenly, a share with each frame, so that what is drawn
// moves as smoothly as the screen can. It is as much later as a block is long.

const LONGEST_MS = 60; // a block is handed on within this; the next one is there by then

export class Pour {
  #blocks = []; // {rows, from: the first that is still to be handed on, until_ms}
  #frame = null;

  // take(rows): what is due
  constructor(take) {
    this.take = take;
  }

  add(rows, now_ms = performance.now()) {
    if (document.hidden) { // no frames come
      this.empty();
      this.take(rows);
      return;
    }
    this.#blocks.push({ rows, from: 0, begin_ms: now_ms, until_ms: now_ms + LONGEST_MS });
    this.#frame ??= requestAnimationFrame((at_ms) => this.#step(at_ms));
  }

  // hands on all that is still waiting
  empty() {
    for (const { rows, from } of this.#blocks.splice(0)) this.take(rows.slice(from));
  }

  #step(now_ms) {
    this.#frame = null;
    for (const block of [...this.#blocks]) {
      const to = dueOf(block, now_ms);
      if (to > block.from) this.take(block.rows.slice(block.from, to));
      block.from = to;
      if (to < block.rows.length) break; // rows stay in order
      this.#blocks.shift();
    }
    if (this.#blocks.length) this.#frame = requestAnimationFrame((at_ms) => this.#step(at_ms));
  }
}

// how many rows of a block are due by then. Pure.
export function dueOf({ rows, from, begin_ms, until_ms }, now_ms) {
  const share = Math.min(1, Math.max(0, (now_ms - begin_ms) / (until_ms - begin_ms)));
  return Math.max(from, Math.ceil(share * rows.length));
}
