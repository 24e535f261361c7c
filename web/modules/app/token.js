// The token: asked for once, kept for this browser tab only (sessionStorage), sent in a header, never in an address.

import { get, token } from "./api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";

export function tokenForm(place) {
  const show = () => (token.get() ? replace(place) : replace(place, form(show)));
  document.addEventListener("token-needed", () => {
    token.forget();
    place.className = "needed";
    if (!place.querySelector("form")) show(); // what is being typed stays
    place.querySelector("input")?.focus();
  });
  show();
}

function form(done) {
  const input = h("input", { type: "password", id: "token-input", autocomplete: "off", spellcheck: "false", required: true });
  const answer = h("div");
  const submit = async (event) => {
    event.preventDefault();
    token.set(input.value.trim());
    const accepted = await attempt(answer, () => get("/token"));
    if (accepted) {
      done();
      document.dispatchEvent(new CustomEvent("token-set"));
    }
  };
  return h("form", { class: "panel row", onsubmit: submit, "aria-label": "Token" },
    h("label", { for: "token-input" }, "Token: to start, stop or change anything, paste what 'friction-bench serve' printed", input),
    h("button", { class: "primary" }, "Use token"), answer);
}
