// What differs between the experiments of a campaign: parameters, each with its values.

import { h, replace } from "../ui/dom.js";
import { numberOrText, resolve } from "../ui/form.js";
import { unitOf, withUnit } from "../ui/format.js";
import { toSi } from "../ui/units.js";

const FIRST = ["load_kg"];

export class Grid {
  #rows = [];

  // schema: of the kind's parameters. Those that are lists already are not varied
  constructor(schema) {
    this.names = Object.entries(schema.properties ?? {}).filter(([, property]) => !["array", undefined].includes(resolve(property, schema).type)).map(([name]) => name);
    this.list = h("div", { class: "form" });
    this.more = h("button", { type: "button", class: "small", onclick: () => this.#add(this.#free()[0]) }, "Vary another one");
    this.element = h("div", {}, this.list, h("div", { class: "row" }, this.more));
    const first = FIRST.find((name) => this.names.includes(name)) ?? this.names[0];
    if (first) this.#add(first);
    this.more.hidden = !this.#free().length;
  }

  // parameter -> values; what cannot be read as a number goes as it is: the service then says what it wants
  values() {
    return Object.fromEntries(this.#rows.filter((row) => row.input.value.trim()).map((row) => [row.choice.value, row.input.value.split(/[,;\s]+/).filter(Boolean).map((text) => inSiUnits(row.choice.value, numberOrText(text)))]));
  }

  #free() {
    const taken = this.#rows.map((row) => row.choice.value);
    return this.names.filter((name) => !taken.includes(name));
  }

  #add(name) {
    const number = this.#rows.length + 1;
    const choice = h("select", { "aria-label": `Parameter ${number}` }, this.names.map((one) => h("option", { value: one, selected: one === name }, withUnit(one))));
    const input = h("input", { "aria-label": `Values of parameter ${number}`, placeholder: "values, such as 0, 0.05, 0.1", autocomplete: "off" });
    const row = { choice, input };
    const drop = h("button", { type: "button", class: "small", "aria-label": `Do not vary parameter ${number}`, onclick: () => {
      this.#rows.splice(this.#rows.indexOf(row), 1);
      this.#shown();
    } }, "×");
    row.element = h("div", { class: "varied" }, choice, input, drop);
    this.#rows.push(row);
    this.#shown();
  }

  #shown() {
    replace(this.list, this.#rows.map((row) => row.element));
    this.more.hidden = !this.#free().length;
  }
}

function inSiUnits(name, value) {
  return typeof value === "number" ? toSi(value, unitOf(name)) : value;
}
