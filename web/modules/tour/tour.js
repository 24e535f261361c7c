// The guided tour: a bar at the foot of the page that says what to do next, shows where, and goes on when it was done.

import { token } from "../app/api.js";
import { h, replace } from "../ui/dom.js";
import { following, STEPS } from "./steps.js";

const KEY = "friction-bench-tour";
const LOOK_EVERY_MS = 250;
const TARGET = "tour-target";

export function tour(place, live) {
  let [shown, led] = [null, null];
  const at = () => (sessionStorage.getItem(KEY) === null ? null : Number(sessionStorage.getItem(KEY)));
  const go = (step) => {
    if (step === null) sessionStorage.removeItem(KEY);
    else sessionStorage.setItem(KEY, String(step));
    look();
  };
  const look = () => {
    const step = at();
    if (step === null) {
      end();
      return;
    }
    const next = following(step, { address: location.hash, status: live.status, token: Boolean(token.get()), seen: (selector) => Boolean(document.querySelector(selector)) });
    if (next !== step) {
      go(next);
      return;
    }
    if (shown !== step) show(step);
    point(STEPS[step]);
  };
  const show = (step) => {
    shown = step;
    document.body.classList.add("touring");
    const { words, at: address } = STEPS[step];
    const last = step === STEPS.length - 1;
    const button = (text, act) => h("button", { type: "button", class: "small", onclick: act }, text);
    replace(place, h("section", { class: "tour", "aria-label": "Guided tour" }, h("span", { class: "soft" }, `${step + 1} of ${STEPS.length}`), h("p", { role: "status" }, words),
      h("div", { class: "actions" }, step > 0 && button("Back", () => go(step - 1)), !last && button("Next", () => go(step + 1)), button(last ? "Done" : "End the tour", () => go(null)))));
    if (address && !location.hash.startsWith(address.split("?")[0])) location.hash = address;
  };
  // where to press: marked, and brought into sight once
  const point = ({ target, sight }) => {
    const found = target.map((selector) => document.querySelector(selector)).find((one) => one?.checkVisibility()) ?? null;
    for (const one of document.querySelectorAll(`.${TARGET}`)) if (one !== found) one.classList.remove(TARGET);
    found?.classList.add(TARGET);
    if (found && found !== led) (sight ? document.querySelector(sight) : found)?.scrollIntoView({ block: "center" });
    led = found;
  };
  const end = () => {
    if (shown === null) return;
    shown = led = null;
    replace(place);
    document.body.classList.remove("touring");
    for (const one of document.querySelectorAll(`.${TARGET}`)) one.classList.remove(TARGET);
  };
  setInterval(look, LOOK_EVERY_MS);
  look();
}

// the view #tour: begins it
export function beginTour() {
  sessionStorage.setItem(KEY, "0");
  location.replace("#bench?kind=steps&repeats=3");
}
