// What waits to be run, in order: seen, removed, paused and resumed.

import { get, post, remove } from "./api.js";
import { h, replace, table } from "./dom.js";
import { number } from "./format.js";
import { attempt } from "./problem.js";

const EVERY_MS = 2000;

// returns {refresh, leave}
export function queuePanel(place) {
  const [list, answer] = [h("div"), h("div")];
  const button = (text, act) => h("button", { type: "button", class: "small", onclick: ({ currentTarget }) => attempt(answer, act, { button: currentTarget }).then(refresh) }, text);
  const pause = button("Pause after this trial", () => post("/queue/pause"));
  const resume = button("Go on: the joint moves", () => post("/queue/resume"));
  replace(place, list, h("div", { class: "row" }, pause, resume), answer);
  let shown = "";
  const refresh = async () => {
    if (document.hidden) return;
    const queue = await attempt(answer, () => get("/queue"));
    if (!queue) return;
    pause.hidden = !queue.running || queue.state !== "running";
    // with nothing waiting there is nothing to go on with, but for a trial that is paused
    resume.hidden = !["paused", "held"].includes(queue.state) || !(queue.waiting.length || queue.running);
    const key = JSON.stringify(queue.waiting.map((one) => one.item_id).concat(queue.state, queue.reason, queue.running?.item_id));
    if (key === shown) return;
    shown = key;
    replace(list, h("p", { class: "soft", role: "status" }, queueWords(queue)), queue.waiting.length > 0 && waiting(queue.waiting));
  };
  const waiting = (items) => table("Waiting", [
    { title: "Experiment", cell: (one) => [one.kind, h("div", { class: "hint" }, [one.note, one.tags.join(", ")].filter(Boolean).join(" · "))] },
    { title: "About [s]", number: true, cell: (one) => number(one.duration_s, 3) },
    { title: "", cell: (one) => h("button", { type: "button", class: "small", "aria-label": `Remove ${one.kind} from the queue`, onclick: () => attempt(answer, () => remove(`/queue/${one.item_id}`)).then(refresh) }, "Remove") },
  ], items);
  refresh();
  const timer = setInterval(refresh, EVERY_MS);
  return { refresh, leave: () => clearInterval(timer) };
}

export function queueWords({ state, reason, running, waiting, left_s: left }) {
  const what = running ? `${running.kind} runs from the queue` : "Nothing runs from the queue";
  const next = waiting.length ? `${waiting.length} waiting, about ${number(Math.round(left))} s left` : "nothing waits";
  const still = state === "held" || state === "paused" ? ` It is ${state}${reason ? `: ${reason}` : ""}.` : "";
  return `${what}; ${next}.${still}`;
}
