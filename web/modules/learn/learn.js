// Learn: a challenge to practise on, and every effect with its physics, its equation and an example.

import { get } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { challengePanel } from "./challenge.js";
import { h, panel, replace } from "../ui/dom.js";
import { effectView } from "./effect.js";
import { equation } from "./equation.js";

export function learnView(place, { rest }) {
  if (rest[0] && rest[0] !== "challenge") return effectView(place, rest[0]);
  const [challenge, list] = [h("div"), h("div", { class: "cards" })];
  const search = h("input", { type: "search", id: "effect-search", autocomplete: "off" });
  replace(place, panel("Practise: what is hidden in this joint?", challenge),
    panel("Effects that a model can be made of", h("label", { for: "effect-search" }, "Search", search), h("div", { class: "gap" }), list));
  const practice = challengePanel(challenge, Number(rest[1]) || null);
  const listed = attempt(list, async () => {
    const { items } = await get("/effects");
    const show = () => replace(list, items.filter((one) => matches(one, search.value)).map(card));
    search.addEventListener("input", show);
    show();
  }, { busy: "Loading …" });
  together(place, [practice, listed]);
  return () => {};
}

// every word must be in it somewhere
export function matches(effect, words) {
  const text = [effect.title, effect.name, effect.physics, effect.driver, effect.excited_by].flat().join(" ").toLowerCase();
  return words.toLowerCase().split(/\s+/).every((word) => text.includes(word));
}

function card(effect) {
  return h("article", { class: "panel" }, h("h3", {}, h("a", { href: `#learn/${effect.name}` }, effect.title)), h("p", {}, effect.physics), equation(effect.equation));
}
