// A form from a JSON schema: units, limits and defaults stand beside each input. The service checks; its words are shown at the field.

import { h, replace } from "./dom.js";
import { nameOf, number } from "./format.js";

export class Form {
  #fields = new Map();

  constructor(schema, prefix) {
    this.schema = schema;
    const rows = Object.entries(schema.properties ?? {}).map(([name, property]) => this.#row(name, property, prefix));
    this.element = h("div", { class: "form" }, rows);
  }

  values() {
    const entries = [...this.#fields].map(([name, field]) => [name, field.read()]);
    return Object.fromEntries(entries.filter(([, value]) => value !== undefined));
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
    const kind = resolve(property, this.schema);
    const id = `${prefix}-${name}`;
    const input = control(kind, id);
    const problem = h("div", { id: `${id}-problem` });
    const hint = [kind.description && `${kind.description}.`, bounds(kind)].filter(Boolean).join(" ");
    const degrees = h("span");
    if (kind.unit === "rad") input.addEventListener("input", () => { degrees.textContent = inDegrees(input.value); });
    degrees.textContent = kind.unit === "rad" ? inDegrees(input.value) : "";
    this.#fields.set(name, {
      read: () => read(kind, input),
      show: (error) => {
        input.setAttribute("aria-invalid", String(Boolean(error)));
        replace(problem, error && h("div", { class: "problem field-problem", role: "alert" }, error.message));
      },
    });
    input.setAttribute("aria-describedby", `${id}-hint ${id}-problem`);
    const text = `${nameOf(name)}${kind.unit ? ` [${kind.unit}]` : ""}`;
    const label = kind.type === "boolean" ? h("label", { class: "inline" }, input, text) : h("label", { for: id }, text, input);
    return h("div", { class: "field" }, label, h("div", { class: "hint", id: `${id}-hint` }, hint, degrees), problem);
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
  const value = kind.default === null || kind.default === undefined ? "" : [kind.default].flat().map((one) => number(one, 12)).join(", ");
  return h("input", { id, type: "text", inputMode: numeric(kind) ? "decimal" : "text", value, autocomplete: "off", placeholder: kind.optional ? "not set" : "" });
}

function numeric(kind) {
  return kind.type === "number" || kind.type === "integer";
}

// what cannot be read as a number goes as it is: the service then says what it wants
function read(kind, input) {
  if (kind.type === "boolean") return input.checked;
  const text = input.value.trim();
  if (text === "") return kind.optional ? null : undefined;
  if (kind.enum) return kind.enum.find((value) => String(value) === text);
  if (kind.type === "array") return text.split(/[,;\s]+/).filter(Boolean).map(numberOrText);
  return numeric(kind) ? numberOrText(text) : text;
}

export function numberOrText(text) {
  const value = Number(text);
  return Number.isFinite(value) ? value : text;
}

function inDegrees(text) {
  const values = text.split(/[,;\s]+/).filter(Boolean).map((one) => (Number(one) * 180) / Math.PI);
  return values.length && values.every(Number.isFinite) ? ` Now ${values.map((one) => `${number(one, 4)}°`).join(", ")}.` : "";
}

function bounds(kind) {
  const source = kind.type === "array" ? { ...kind.items } : kind;
  const low = source.minimum ?? source.exclusiveMinimum;
  const high = source.maximum ?? source.exclusiveMaximum;
  const unit = kind.unit ? ` ${kind.unit}` : "";
  const each = kind.type === "array" ? "Several, separated by commas. " : "";
  if (low !== undefined && high !== undefined) return `${each}${number(low)} to ${number(high)}${unit}.`;
  if (low !== undefined) return `${each}${source.minimum === undefined ? "Above" : "At least"} ${number(low)}${unit}.`;
  if (high !== undefined) return `${each}At most ${number(high)}${unit}.`;
  return each.trim();
}
