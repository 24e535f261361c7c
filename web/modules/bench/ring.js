// Columns of numbers, the newest so many rows; the oldest go. Memory is taken once, whatever runs for however long.

export class Ring {
  #columns = new Map();
  #capacity;
  #end = 0;
  #start = 0;

  constructor(channels, capacity) {
    this.#capacity = capacity;
    for (const name of channels) this.#columns.set(name, new Float64Array(2 * capacity));
  }

  get channels() {
    return [...this.#columns.keys()];
  }

  get length() {
    return this.#end - this.#start;
  }

  // rows: arrays in the order of the channels; null, which is "not measured", becomes NaN
  append(rows) {
    for (const row of rows) {
      if (this.#end === 2 * this.#capacity) this.#compact();
      let index = 0;
      for (const column of this.#columns.values()) {
        column[this.#end] = row[index] ?? NaN;
        index += 1;
      }
      this.#end += 1;
    }
    this.#start = Math.max(this.#start, this.#end - this.#capacity);
  }

  clear() {
    this.#start = 0;
    this.#end = 0;
  }

  // a view without a copy, true until the next append; undefined where there is no such channel
  column(name) {
    return this.#columns.get(name)?.subarray(this.#start, this.#end);
  }

  copy() {
    const copied = new Map(this.channels.map((name) => [name, this.column(name).slice()]));
    return { column: (name) => copied.get(name), length: this.length };
  }

  #compact() {
    for (const column of this.#columns.values()) column.copyWithin(0, this.#capacity, 2 * this.#capacity);
    this.#end = this.#capacity;
    this.#start = 0;
  }
}
