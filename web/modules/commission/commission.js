// Commissioning, one step a screen: what will move and how far, the question, the drawing, what was found so far.
// STOP stands in the head of the page, as ever.

import { get, post, token } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { h, panel, replace } from "../ui/dom.js";
import { withShownUnit } from "../ui/units.js";
import { beginning, ending } from "./ends.js";
import { evidenceTable } from "./evidence.js";
import { questionForm } from "./question.js";
import { isPowered, stepDrawing } from "./stepdrawing.js";

const EVERY_MS = 400;

export const commission = { open: commissionView, from: "bench", text: "Commission a joint of your own" };

function commissionView(place, bench) {
  const [rail, screen, found, answer] = [h("ol", { class: "way", "aria-label": "Steps" }), h("div"), h("div"), h("div")];
  const [joint, motion] = [h("div", { class: "step-joint" }), h("p", { class: "soft motion-now", role: "status" })];
  const picture = h("div", {}, joint, motion);
  const whole = h("div", { class: "step" }, h("div", {}, screen, answer), picture);
  replace(place, panel("Commission your own joint", rail, whole), panel("Found so far", found));
  const drawing = stepDrawing(joint, bench);
  let [shown, asking] = ["", false];

  const act = async (button, action) => {
    await attempt(answer, action, { button });
    await refresh();
  };
  const refresh = async () => {
    if (asking || document.hidden) return;
    asking = true;
    const now = await get("/commission").catch(() => null);
    asking = false;
    if (now) show(now);
  };
  const show = (now) => {
    motion.textContent = motionWords(now, bench.live.status);
    const key = keyOf(now);
    if (key === shown) return;
    shown = key;
    const step = now.steps.find((one) => one.key === now.step);
    const begun = ["asking", "working"].includes(now.state);
    replace(rail, way(now));
    picture.hidden = !begun;
    if (begun) drawing.show(step, now.question);
    replace(answer);
    replace(screen, begun ? stepScreen(now, step, act) : [ending(now), now.state === "commissioned" ? h("details", {}, h("summary", {}, "Commission another joint"), beginning(now, act)) : beginning(now, act)]);
    replace(found, evidenceTable(now.evidence));
    found.parentElement.hidden = !now.evidence.length;
    // whoever follows with the keyboard goes on where the question is
    if (now.question || now.prompt) screen.querySelector("input, button")?.focus({ preventScroll: true });
  };
  const first = refresh();
  const timer = setInterval(refresh, EVERY_MS);
  document.addEventListener("token-set", refresh);
  together(place, [first]);
  return () => {
    clearInterval(timer);
    document.removeEventListener("token-set", refresh);
    drawing.leave();
  };
}

// what is drawn anew only when it has changed: a field that is being filled in stays
export function keyOf(now) {
  return JSON.stringify([now.number, now.state, now.step, now.question?.number, now.prompt?.number, now.evidence.length, now.obstacle, Boolean(token.get())]);
}

function way({ steps, step, state }) {
  const at = steps.findIndex((one) => one.key === step);
  const done = (index) => state === "commissioned" || index < at;
  const current = (index) => index === at && state !== "commissioned";
  return steps.map(({ title }, index) => h("li", { class: done(index) ? "done" : "", "aria-current": current(index) ? "step" : null }, title,
    done(index) && h("span", { class: "unseen" }, " (done)")));
}

function stepScreen(now, step, act) {
  const prompt = now.prompt && { ...now.prompt, key: "hang", wants_value: false };
  const asked = now.question ?? prompt;
  const path = now.question ? "/commission/answer" : "/continue";
  const body = (value) => (now.question ? { question: asked.number, value } : { prompt: asked.number });
  return [
    h("h3", {}, step.title), h("p", { class: isPowered(step) ? "powered" : "unpowered" }, step.moves, " ", isPowered(step) && reach(step)),
    asked ? questionForm(asked, (button, value) => act(button, () => post(path, body(value)))) : h("p", { class: "sentence", role: "status" }, "Nothing is to be done now. STOP, or Esc, ends it at any time."),
    h("div", { class: "row" }, h("button", { type: "button", class: "small", onclick: ({ currentTarget }) => act(currentTarget, () => post("/stop", { reason: "commissioning given up on the page" })) }, "Give up")),
  ];
}

// also of the drawing: the orange arc
function reach({ low_rad, high_rad }) {
  return `The arm stays within ${withShownUnit(low_rad, "rad", 2)} to ${withShownUnit(high_rad, "rad", 2)}.`;
}

// what moves now
function motionWords(now, status) {
  const run = status?.run;
  if (!["asking", "working"].includes(now.state) || status?.state !== "running" || !run) return "";
  return `${run.kind}, experiment ${run.experiment_id}: trial ${run.trial_index + 1} of ${run.trial_count}`;
}
