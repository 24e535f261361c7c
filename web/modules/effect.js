// One effect: physics, equation, parameters, what excites it, what it is confused with, and an example to play with.

import { get } from "./api.js";
import { facts, h, panel, replace } from "./dom.js";
import { equation } from "./equation.js";
import { examplePlot } from "./example.js";
import { nameOf, number } from "./format.js";
import { attempt } from "./problem.js";
import { together } from "./together.js";

export function effectView(place, name) {
  const [text, picture] = [h("div"), h("div", { class: "example" })];
  let plot = null;
  let left = false;
  replace(place, h("p", {}, h("a", { href: "#learn" }, "All effects")), text);
  const described = attempt(text, async () => {
    const { items } = await get("/effects");
    const effect = items.find((one) => one.name === name);
    if (!effect) throw new Error(`There is no effect ${name}.`);
    replace(text, description(effect, items));
  });
  const shown = described.then(() => { // what is above it does not push it down
    if (!left) place.append(panel("A simulated example", picture));
  });
  attempt(picture, async () => {
    const [example] = await Promise.all([get(`/effects/${encodeURIComponent(name)}/example`), shown]);
    if (!left) plot = examplePlot(picture, example);
  }, { busy: "Computing …" });
  together(place, [shown]);
  return () => {
    left = true;
    plot?.close();
  };
}

function description(effect, all) {
  const parameters = effect.parameters.map((one) => `${one.name} [${one.unit}], ${bound(one.low, "−∞")} to ${bound(one.high, "∞")}`);
  const titles = (names) => names.map((name, index) => [index > 0 && ", ", h("a", { href: `#learn/${name}` }, all.find((one) => one.name === name)?.title ?? name)]);
  return panel(effect.title, h("p", { class: "lead" }, effect.physics), equation(effect.equation),
    facts([["parameters", parameters.join("; ")], ["driven by", nameOf(effect.driver)], ["needs", effect.channels.map(nameOf).join(", ") || "position and effort"],
      ["excited by", [effect.excited_by].flat().join(", ")], ["confused with", effect.confused_with.length ? titles(effect.confused_with) : "–"],
      ["source", effect.source], ["name", effect.name]]));
}

function bound(value, none) {
  return value === null || value === undefined ? none : number(value);
}
