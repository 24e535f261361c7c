// Big numbers, for a tablet beside the bench: what is read from some metres away, and STOP as large as can be.

import { readingNote } from "../app/state.js";
import { newest } from "../bench/load.js";
import { currentName, readingText } from "../bench/liveplot.js";
import { eachFrame, liveJoint, rowOf } from "../joint/livejoint.js";
import { h, replace } from "../ui/dom.js";
import { duration } from "../ui/format.js";

export const numbers = { open: numbersView, from: "bench", text: "Big numbers, for a tablet beside the bench" };

function numbersView(place, { live, state }) {
  const [joint, doing, note] = [h("div", { class: "numbers-joint" }), h("p", { class: "numbers-doing", role: "status" }), h("p", { class: "soft numbers-note" })];
  const [angle, current, load, left] = ["angle", currentName(), "load current", "time left"].map((text) => {
    const value = h("dd", {}, "–");
    const name = h("dt", {}, text);
    return { name, value, element: h("div", {}, name, value) };
  });
  const stop = h("button", { type: "button", class: "stop numbers-stop", onclick: () => document.getElementById("stop").click() }, "STOP");
  replace(place, h("section", { class: "numbers" }, doing, h("div", { class: "numbers-body" }, joint,
    h("dl", { class: "numbers-values" }, [angle, current, load, left].map(({ element }) => element))), note, stop));
  const show = () => {
    const now = state.now;
    const { status } = now;
    const row = rowOf(live, now);
    const run = status?.run;
    angle.value.textContent = Number.isFinite(row.position_rad) ? readingText(row.position_rad, "rad") : "–";
    current.value.textContent = Number.isFinite(row.current_a) ? readingText(row.current_a, "A") : "–";
    current.name.textContent = currentName(status?.reading);
    load.value.textContent = newest(live.rows) ?? "–";
    left.value.textContent = now.running && run?.left_s > 0 ? duration(run.left_s) : "–";
    const words = doingWords(now);
    if (doing.textContent !== words) doing.textContent = words;
    const { dimmed, words: aged } = readingNote(now);
    place.classList.toggle("dimmed", dimmed);
    note.textContent = aged || "\u00a0";
  };
  const { leave } = eachFrame({ live, state }, show);
  const leaveJoint = liveJoint(joint, { live, state });
  show();
  return () => {
    place.classList.remove("dimmed");
    leaveJoint();
    leave();
  };
}

export function doingWords({ fresh, status, running }) {
  if (!fresh) return "No news from the service";
  const run = status?.run;
  if (!run) return "Nothing has run yet";
  if (!running) return `${run.power_off === "failed" ? "The drive may still have power" : "The drive is off"}: ${run.kind} ${run.outcome}`;
  return `${run.kind}, trial ${run.trial_index + 1} of ${run.trial_count}`;
}
