// A form from a JSON schema: units, limits and defaults stand beside each input. What is typed is checked at once; what
// the service says of it is shown at the field, too. Values are shown in the units that people chose, and sent in SI.

import { h, replace } from "./dom.js";
import { nameOf, number, plain } from "./format.js";
import { shownUnit, withShownUnit } from "./units.js";

export class Form {
  #fields = new Map();

  // changed(): something was typed
  constructor(schema, prefix, changed = () => {}) {
    this.schema = schema;
    this.changed = changed;
    const rows = Object.entries(schema.properties ?? {}).map(([name, property]) => this.#row(name, property, prefix));
    this.element = h("div", { class: "form" }, rows);
  }

  values() {
    const entries = [...this.#fields].map(([name, field]) => [name, field.read()]);
    return Object.fromEntries(entries.filter(([, value]) => value !== undefined));
  }

  // marks what cannot be sent; true where all can
  check() {
    return [...this.#fields.values()].map((field) => field.check()).every(Boolean);
  }

  // fills the fields with values in SI, by name; others keep what they have
  fill(values) {
    for (const [name, value] of Object.entries(values)) this.#fields.get(name)?.write(value);
  }

  // returns the problems that belong to no field of this form
  showProblems(errors, path) {
    for (const field of this.#fields.values()) field.show(null);
    return errors.filter((error) => {
      const field = this.#fields.get(error.field.replace(`${path}.`, "").split(".")[0]);
      field?.show(error);
      return !field;
    });
  }

  #row(name, property, prefix) {
    const found = resolve(property, this.schema);
    // as it was when the field was made: a switch of units draws the form anew, and never reads this one otherwise
    const kind = { ...found, shown: shownUnit(found.unit ?? "") };
    const id = `${prefix}-${name}`;
    const input = control(kind, id);
    const problem = h("div", { id: `${id}-problem` });
    const show = (message) => {
      input.setAttribute("aria-invalid", String(Boolean(message)));
      replace(problem, message && h("div", { class: "problem field-problem", role: "alert" }, message));
      // while it is typed: what is said of it may stand behind the bar with Start
      if (message && document.activeElement === input) problem.scrollIntoView({ block: "nearest" });
    };
    const check = () => {
      const message = problemOf(kind, read(kind, input));
      show(message);
      return !message;
    };
    this.#fields.set(name, { read: () => read(kind, input), write: (value) => write(kind, input, value), show: (error) => show(error && limitWords(error)), check });
    input.addEventListener("input", () => {
      check();
      this.changed();
    });
    input.setAttribute("aria-describedby", `${id}-hint ${id}-problem`);
    const unit = unitText(kind);
    const text = `${nameOf(name)}${unit ? ` [${unit}]` : ""}`;
    const label = kind.type === "boolean" ? h("label", { class: "inline" }, input, text) : h("label", { for: id }, text, input);
    const hint = [kind.description && `${kind.description}.`, bounds(kind)].filter(Boolean).join(" ");
    return h("div", { class: "field" }, label, h("div", { class: "hint", id: `${id}-hint` }, hint), problem);
  }
}

// pydantic writes optional values as anyOf with null, and enums as references
export function resolve(property, schema) {
  const { anyOf, allOf, $ref, ...rest } = property;
  const options = (anyOf ?? allOf ?? []).filter((option) => option.type !== "null");
  const inner = options.length ? resolve(options[0], schema) : {};
  const named = $ref ? schema.$defs[$ref.split("/").pop()] : {};
  return { ...named, ...inner, ...rest, optional: Boolean(anyOf && anyOf.some((option) => option.type === "null")) };
}

function control(kind, id) {
  if (kind.enum) return h("select", { id }, kind.enum.map((value) => h("option", { value, selected: value === kind.default }, String(value))));
  if (kind.type === "boolean") return h("input", { id, type: "checkbox", checked: kind.default === true });
  if (kind.file) return h("textarea", { id, rows: 6, spellcheck: false, placeholder: "t_s,position_rad\n0,0\n..." });
  return h("input", { id, type: "text", inputMode: numeric(kind) ? "decimal" : "text", value: shownText(kind, kind.default), autocomplete: "off", placeholder: kind.optional ? "not set" : "" });
}

function shownText(kind, value) {
  if (value === null || value === undefined) return "";
  return [value].flat().map((one) => (typeof one === "number" ? plain(upscaled(one, kind, 12), kind.shown.factor === 1 ? 6 : 4) : one)).join(", ");
}

function write(kind, input, value) {
  if (kind.type === "boolean") input.checked = value === true;
  else input.value = kind.enum ? String(value) : shownText(kind, value);
}

function numeric(kind) {
  return kind.type === "number" || kind.type === "integer";
}

// what cannot be read as a number goes as it is: the check, and the service, then say what is wanted
function read(kind, input) {
  if (kind.type === "boolean") return input.checked;
  const text = input.value.trim();
  if (text === "") return kind.optional ? null : undefined;
  if (kind.enum) return kind.enum.find((value) => String(value) === text);
  // what nobody changed is sent as it came: a conversion there and back would round it
  if (text === shownText(kind, kind.default)) return kind.default;
  const value = (one) => (typeof one === "number" ? downscaled(one, kind) : one);
  if (kind.type === "array") return text.split(/[,;\s]+/).filter(Boolean).map((one) => value(numberOrText(one)));
  return numeric(kind) ? value(numberOrText(text)) : text;
}

export function numberOrText(text) {
  const value = Number(text);
  return Number.isFinite(value) ? value : text;
}

// what the service says of a value outside its bounds, in the units that are shown: nobody has typed the 8.7 rad of 500°
export function limitWords({ message, found, allowed = {}, unit = "" }) {
  const { ge, gt, le, lt, margin } = allowed;
  const [low, high] = [ge ?? gt, le ?? lt];
  // in SI its own sentence, which knows more: "Are degrees meant?"
  if (shownUnit(unit).factor === 1 || typeof found !== "number" || (low ?? high) === undefined) return message;
  const said = (value) => withShownUnit(value, unit);
  const least = low !== undefined && `${ge === undefined ? "above" : "at least"} ${said(low)}`;
  const most = high !== undefined && `${le === undefined ? "below" : "at most"} ${said(high)}`;
  const range = least && most && ge !== undefined && le !== undefined ? `${said(low)} to ${said(high)}` : [least, most].filter(Boolean).join(" and ");
  return `${said(found)} is not allowed; allowed is ${range}${margin ? ` (the limits of the bench less a margin of ${said(margin)})` : ""}.`;
}

// what is wrong with a value that would be sent, in the units that are shown; "" where nothing is
export function problemOf(kind, value) {
  if (value === null) return "";
  if (value === undefined) return numeric(kind) && kind.default === undefined ? "A number is missing." : "";
  if (kind.type === "array") return [value].flat().map((one) => problemOf({ ...kind.items, unit: kind.unit, shown: kind.shown }, one)).find(Boolean) ?? "";
  if (!numeric(kind)) return "";
  if (typeof value !== "number") return `'${value}' is no number.`;
  if (kind.type === "integer" && !Number.isInteger(value)) return `${number(value)} is no whole number.`;
  const { minimum, maximum, exclusiveMinimum: above, exclusiveMaximum: below } = kind;
  const inside = value >= (minimum ?? -Infinity) && value <= (maximum ?? Infinity) && value > (above ?? -Infinity) && value < (below ?? Infinity);
  return inside ? "" : `${shown(value, kind)} is not allowed. ${bounds(kind)}`;
}

function shown(value, kind) {
  return `${number(upscaled(value, kind))}${unitText(kind) ? ` ${unitText(kind)}` : ""}`;
}

function upscaled(value, { shown: { factor } }, digits = 6) {
  return factor === 1 ? value : Number((value * factor).toPrecision(digits));
}

function downscaled(value, { shown: { factor } }) {
  return factor === 1 ? value : Number((value / factor).toPrecision(12));
}

function unitText(kind) {
  return kind.shown.unit;
}

function bounds(kind) {
  const source = kind.type === "array" ? { ...kind.items, unit: kind.unit } : kind;
  const low = source.minimum ?? source.exclusiveMinimum;
  const high = source.maximum ?? source.exclusiveMaximum;
  const each = kind.type === "array" ? "Several, separated by commas. " : "";
  if (low !== undefined && high !== undefined) return `${each}${number(upscaled(low, kind))} to ${shown(high, kind)}.`;
  if (low !== undefined) return `${each}${source.minimum === undefined ? "Above" : "At least"} ${shown(low, kind)}.`;
  if (high !== undefined) return `${each}At most ${shown(high, kind)}.`;
  return each.trim();
}
