// The catalogue: each effect's physics, equation, parameters, what excites it and what it is confused with.

import { get } from "./api.js";
import { facts, h, panel, replace } from "./dom.js";
import { equation } from "./equation.js";
import { nameOf, number } from "./format.js";
import { attempt } from "./problem.js";

export function effectsView(place) {
  const list = h("div", { class: "cards" });
  replace(place, panel("Effects that a model can be made of", list));
  attempt(list, async () => replace(list, (await get("/effects")).items.map(card)), { busy: "Loading …" });
  return () => {};
}

function card(effect) {
  const parameters = effect.parameters.map((one) => `${one.name} [${one.unit}], ${bound(one.low, "−∞")} to ${bound(one.high, "∞")}`);
  const words = (names) => names.map((name) => name.replaceAll("_", " ")).join(", ") || "–";
  return h("article", { class: "panel" }, h("h3", {}, effect.title), h("p", {}, effect.physics), equation(effect.equation),
    facts([["name", effect.name], ["parameters", parameters.join("; ")], ["driven by", nameOf(effect.driver)], ["needs", effect.channels.map(nameOf).join(", ") || "position and effort"],
      ["excited by", [effect.excited_by].flat().join(", ")], ["confused with", words(effect.confused_with)], ["source", effect.source]]));
}

function bound(value, none) {
  return value === null || value === undefined ? none : number(value);
}
