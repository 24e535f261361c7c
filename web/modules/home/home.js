// The first page: what this is in a sentence, the joint as it is now, and three ways in.

import { liveJoint } from "../joint/livejoint.js";
import { h, replace } from "../ui/dom.js";

// words are few on purpose; see tests/browser/test_home.py
const DOORS = [
  { title: "Watch a run", text: "Start, see, stop.", href: "#bench?kind=steps&repeats=2" },
  { title: "Find a hidden effect", text: "What does a model lack?", href: "#learn/challenge" },
  { title: "Bring my own recording", text: "Import, then study it.", href: "#trials/import" },
];

export function homeView(place, bench) {
  const joint = h("div", { class: "home-joint" });
  replace(place, h("section", { class: "home" },
    h("div", {}, h("p", { class: "home-sentence" }, "Run one geared joint, and find out which physical effect your model of it lacks."),
      h("div", { class: "doors" }, DOORS.map(({ title, text, href }) => h("a", { class: "door", href }, h("strong", {}, title), h("span", {}, text)))),
      h("p", {}, h("a", { href: "#tour" }, "Guided tour, five minutes"))),
    joint));
  return liveJoint(joint, bench);
}
