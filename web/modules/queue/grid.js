// What differs between the experiments of a campaign: parameters, each with its values.

import { h, replace } from "../ui/dom.js";
import { numberOrText, resolve } from "../ui/form.js";
import { plain, unitOf, withUnit } from "../ui/format.js";
import { toShown, toSi } from "../ui/units.js";

const FIRST = ["load_kg"];

export class Grid {
  #rows = [];

  // schema: of the kind's parameters. Those that are lists already are not varied
  constructor(schema) {
    const properties = Object.entries(schema.properties ?? {}).map(([name, property]) => [name, resolve(property, schema)]);
    this.properties = Object.fromEntries(properties.filter(([, { type }]) => !["array", undefined].includes(type)));
    this.names = Object.keys(this.properties);
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
    const place = this.#rows.length + 1;
    const choice = h("select", { "aria-label": `Parameter ${place}` }, this.names.map((one) => h("option", { value: one, selected: one === name }, withUnit(one))));
    const input = h("input", { "aria-label": `Values of parameter ${place}`, autocomplete: "off" });
    const example = () => Object.assign(input, { placeholder: `values, such as ${exampleOf(choice.value, this.properties[choice.value])}` });
    choice.addEventListener("change", example);
    example();
    const row = { choice, input };
    const drop = h("button", { type: "button", class: "small", "aria-label": `Do not vary parameter ${place}`, onclick: () => {
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

// three values of a parameter in the unit that its field names: about its default, within its limits
export function exampleOf(name, { type, enum: choices, default: usual, minimum = -Infinity, maximum = Infinity }) {
  if (choices) return choices.slice(0, 3).join(", ");
  if (type === "boolean") return "false, true";
  if (type === "integer") return [0, 1, 2].map((more) => Math.min((usual ?? Math.max(minimum, 1)) + more, maximum)).join(", ");
  if (type !== "number") return "a, b";
  const about = usual ? [0.5, 1, 1.5].map((share) => share * usual) : [0, 0.05, 0.1];
  return about.filter((value) => value >= minimum && value <= maximum).map((value) => plain(toShown(value, unitOf(name)), 3)).join(", ");
}

function inSiUnits(name, value) {
  return typeof value === "number" ? toSi(value, unitOf(name)) : value;
}
