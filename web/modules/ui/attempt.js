// Errors shown where they arose, in the words of the service.
// A view shows itself when its first answers are there, all at once: nothing jumps while it fills.

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

const LONGEST_MS = 5000; // then what there is is shown; STOP, in the head of the page, waits for nothing

export function together(place, firstAnswers) {
  const timer = setTimeout(() => show(), LONGEST_MS);
  const show = () => {
    clearTimeout(timer);
    place.classList.remove("filling");
    place.removeAttribute("aria-busy");
  };
  place.classList.add("filling");
  place.setAttribute("aria-busy", "true");
  Promise.allSettled(firstAnswers).then(show);
}
