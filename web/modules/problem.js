// Errors shown where they arose, in the words of the service.

import { h } from "./dom.js";

export function problemBox(error) {
  return h("div", { class: "problem", role: "alert" }, error.message);
}

// runs an action; `place` says meanwhile that it is busy, and afterwards what went wrong
export async function attempt(place, action, { button = null, busy = "" } = {}) {
  if (busy) place.replaceChildren(h("p", { class: "busy", role: "status" }, busy));
  else place.querySelector(":scope > .problem")?.remove();
  if (button) button.disabled = true;
  try {
    const result = await action();
    if (busy) place.querySelector(":scope > .busy")?.remove();
    return result;
  } catch (error) {
    if (error.name !== "AbortError") place.replaceChildren(problemBox(error));
    return undefined;
  } finally {
    if (button) button.disabled = false;
  }
}
