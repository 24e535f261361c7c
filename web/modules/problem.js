// Errors shown where they arose, in the words of the service.

import { h } from "./dom.js";

export function problemBox(error) {
  return h("div", { class: "problem", role: "alert" }, error.message);
}

// runs an action, shows what went wrong in `place`, and disables the button meanwhile
export async function attempt(place, action, button = null) {
  place.replaceChildren();
  if (button) button.disabled = true;
  try {
    return await action();
  } catch (error) {
    if (error.name !== "AbortError") place.replaceChildren(problemBox(error));
    return undefined;
  } finally {
    if (button) button.disabled = false;
  }
}
