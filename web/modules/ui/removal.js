// A record is removed for good: asked for with a reason, which the audit log keeps with who and when.

import { remove } from "../app/api.js";
import { attempt } from "./attempt.js";
import { h, replace } from "./dom.js";

const LONGEST = 200; // characters of a reason

// what: "experiment 7"; loses: what goes with it, in words; done(): it is gone. The question stands where `place` is
export function removeButton(place, { what, loses, path, done }) {
  const button = h("button", { class: "small", type: "button", "aria-label": `Remove ${what}`, onclick: () => {
    button.disabled = true;
    replace(place, question());
    place.querySelector("input").focus();
  } }, "Remove");
  const away = () => {
    button.disabled = false;
    replace(place);
  };
  const question = () => {
    const [why, answer] = [h("input", { required: true, maxlength: String(LONGEST), autocomplete: "off" }), h("div")];
    const submit = async (event) => {
      event.preventDefault();
      const gone = await attempt(answer, async () => {
        await remove(`${path}?${new URLSearchParams({ reason: why.value.trim() })}`);
        return true;
      }, { button: event.submitter });
      if (gone) done();
    };
    return h("form", { class: "problem form", "aria-label": `Remove ${what}`, onsubmit: submit }, h("strong", {}, `Remove ${what} ${loses}, for good?`),
      h("label", {}, "Why: kept in the audit log", why),
      h("div", { class: "row" }, h("button", { class: "small" }, "Remove for good"), h("button", { type: "button", class: "small", onclick: away }, "Keep it")), answer);
  };
  return button;
}
