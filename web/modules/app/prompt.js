// What the bench asks its person to do before it goes on, and the button that says it is done.

import { post } from "./api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";

export function promptBar(place, live) {
  let shown = null;
  live.addEventListener("status", () => {
    const prompt = live.status?.prompt ?? null;
    if ((prompt?.number ?? null) === shown) return;
    shown = prompt?.number ?? null;
    if (prompt) show(place, prompt);
    else replace(place);
  });
}

function show(place, prompt) {
  const answer = h("div");
  const button = h("button", { type: "button" }, "Continue");
  button.addEventListener("click", async () => {
    button.disabled = true;
    await attempt(answer, () => post("/continue", { prompt: prompt.number }));
    button.disabled = false;
  });
  replace(place, h("div", { class: "prompt" }, h("span", {}, prompt.sentence), button, answer));
}
