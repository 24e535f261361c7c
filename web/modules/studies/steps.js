// The steps of a study: one is shown at a time, each has an address.

import { note } from "../app/address.js";
import { h, replace } from "../ui/dom.js";

export const STEPS = [
  ["record", "Record"], ["compare", "Compare"], ["diagnose", "Diagnose"], ["add", "Add"], ["result", "Result"],
];

export class Steps {
  // place: of the links; parts: name -> element; address(step): what it is called
  constructor(place, parts, { address, first }) {
    Object.assign(this, { parts, address });
    this.links = new Map(STEPS.map(([name, text], at) => [name, h("a", { href: "#", "data-step": name, onclick: (event) => this.#chosen(event, name) }, `${at + 1} ${text}`)]));
    replace(place, h("nav", { class: "steps", "aria-label": "Steps of the study" }, [...this.links.values()]));
    this.show(this.parts[first] ? first : "compare", { step: false });
  }

  show(name, { step = true } = {}) {
    this.current = name;
    for (const [one, link] of this.links) {
      this.parts[one].hidden = one !== name;
      if (one === name) link.setAttribute("aria-current", "step");
      else link.removeAttribute("aria-current");
    }
    this.say({ step });
  }

  say({ step = false } = {}) {
    note(this.address(this.current), { step });
  }

  #chosen(event, name) {
    event.preventDefault();
    this.show(name);
  }
}
