// What waits to be run, in order: seen, removed, paused and resumed.

import { get, patch, post, remove } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { outcome } from "../ui/files.js";
import { conditions, duration } from "../ui/format.js";

const EVERY_MS = 2000;

// whole: also to move, to clear, and what came out of it last; returns {first, refresh, leave}; first: its first answer
export function queuePanel(place, { whole = false } = {}) {
  const [list, answer] = [h("div"), h("div")];
  const [sentence, left] = [h("span", { role: "status" }), h("span")]; // the time left changes all the time: it is not read aloud
  const button = (text, act) => h("button", { type: "button", class: "small", onclick: ({ currentTarget }) => attempt(answer, act, { button: currentTarget }).then(refresh) }, text);
  const pause = button("Pause after this trial", () => post("/queue/pause"));
  const resume = button("Go on: the joint moves", () => post("/queue/resume"));
  const clear = button("Remove all that waits", () => remove("/queue"));
  replace(place, h("p", { class: "soft" }, sentence, " ", left), list, h("div", { class: "row" }, pause, resume, whole && clear), answer);
  let shown = "";
  const refresh = async () => {
    if (document.hidden) return;
    const queue = await attempt(answer, () => get("/queue"));
    if (!queue) return;
    pause.hidden = !queue.running || queue.state !== "running";
    // with nothing waiting there is nothing to go on with, but for a trial that is paused
    resume.hidden = !["paused", "held"].includes(queue.state) || !(queue.waiting.length || queue.running);
    clear.hidden = !queue.waiting.length;
    const words = queueWords(queue);
    if (words !== sentence.textContent) sentence.textContent = words;
    left.textContent = queue.left_s > 0 ? `About ${duration(queue.left_s)} left.` : "";
    const key = JSON.stringify([queue.waiting.map((one) => one.item_id), queue.ended[0]?.item_id]);
    if (key === shown) return;
    shown = key;
    replace(list, queue.waiting.length > 0 && waiting(queue.waiting), whole && queue.ended.length > 0 && ended(queue.ended));
  };
  const act = (text, label, action) => h("button", { type: "button", class: "small", "aria-label": label, onclick: () => attempt(answer, action).then(refresh) }, text);
  const move = (one, position) => () => patch(`/queue/${one.item_id}`, { position });
  const waiting = (items) => table("Waiting", [
    { title: "Experiment", cell: (one) => [one.kind, h("div", { class: "hint" }, described(one))] },
    { title: "About", number: true, cell: (one) => duration(one.duration_s) },
    { title: "", cell: (one) => {
      const at = items.indexOf(one);
      return h("div", { class: "actions" }, whole && at > 0 && act("Up", `Run ${one.kind} at place ${at + 1} earlier`, move(one, at - 1)),
        whole && at < items.length - 1 && act("Down", `Run ${one.kind} at place ${at + 1} later`, move(one, at + 1)),
        act("Remove", `Remove ${one.kind} from the queue`, () => remove(`/queue/${one.item_id}`)));
    } },
  ], items);
  const ended = (items) => [h("h3", {}, "Came out of it last"), table("Came out of the queue", [
    { title: "Experiment", cell: (one) => [one.experiment_id ? `${one.experiment_id}: ${one.kind}` : one.kind, h("div", { class: "hint" }, described(one))] },
    { title: "Outcome", cell: (one) => outcome({ outcome: one.state, reason: one.reason }) },
  ], items)];
  const first = refresh();
  const timer = setInterval(refresh, EVERY_MS);
  return { first, refresh, leave: () => clearInterval(timer) };
}

// what it is done under, as far as it was said, and what is noted with it
function described({ parameters, note, tags }) {
  return [conditions(parameters), note, tags.join(", ")].filter(Boolean).join(" · ");
}

export function queueWords({ state, reason, running, waiting_count: count }) {
  const what = running ? `${running.kind} runs from the queue` : "Nothing runs from the queue";
  const next = count ? `${count} waiting` : "nothing waits";
  const still = state === "held" || state === "paused" ? ` The queue is paused${reason ? `: ${reason}` : ""}.` : "";
  return `${what}; ${next}.${still}`;
}
