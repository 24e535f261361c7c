// A calibration that measures where it knows least: begun, watched, paused, gone on with.

import { get, post } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";
import { duration, number } from "../ui/format.js";

const EVERY_MS = 1000;
const BUSY = ["running", "pausing", "paused", "fitting"];

// made(calibration_id): there is a new one; returns {first, leave}
export function calibrationRun(place, made) {
  const accuracy = h("input", { id: "calibration-accuracy", type: "number", min: 0.01, step: "any", value: "5", required: true });
  const minutes = h("input", { id: "calibration-minutes", type: "number", min: 0.5, step: "any", value: "4", required: true });
  const [answer, sentence, left] = [h("div"), h("p", { role: "status" }), h("span", { class: "soft" })];
  const bar = h("progress", { max: 1, "aria-label": "Share of the longest time" });
  let [now, told] = [null, null];
  const act = (action) => ({ currentTarget }) => attempt(answer, action, { button: currentTarget }).then(refresh);
  const wanted = () => ({ accuracy_a: Number(accuracy.value) / 1000, budget_s: 60 * Number(minutes.value) });
  const begin = (more) => attempt(answer, () => post("/calibrations/run", { ...wanted(), ...more })).then(refresh);
  const button = (text, action) => h("button", { type: "button", class: "small", onclick: action }, text);
  const pause = button("Pause after this trial", act(() => post("/calibrations/run/pause")));
  const resume = button("Go on: the joint moves", act(() => post("/calibrations/run/resume")));
  const again = button("Go on with what was measured: the joint moves", () => begin({ after: now.experiment_ids }));
  const form = h("form", { class: "row", onsubmit: (event) => { event.preventDefault(); begin({}); } },
    h("label", { for: "calibration-accuracy" }, "Known to [mA]", accuracy), h("label", { for: "calibration-minutes" }, "Time for the curves [min]", minutes),
    h("button", { class: "primary" }, "Measure: the joint moves"));
  const bars = h("div", { class: "waiting" }, bar, left, h("div", { class: "row" }, pause, resume));
  replace(place, h("h3", {}, "Measure where the curves are known least"), form, sentence, bars, h("div", { class: "row" }, again), answer);
  const refresh = async () => {
    if (document.hidden) return;
    const found = await get("/calibrations/run").catch(() => null);
    if (!found) return;
    now = found;
    const busy = BUSY.includes(now.state);
    form.hidden = busy;
    bars.hidden = !busy;
    pause.hidden = now.state !== "running";
    resume.hidden = !["pausing", "paused"].includes(now.state);
    again.hidden = now.state !== "ended" || !now.experiment_ids.length;
    bar.value = now.progress;
    left.textContent = now.left_s > 0 ? `At most ${duration(now.left_s)} of the joint's time left.` : "";
    const words = runWords(now);
    if (words !== sentence.textContent) sentence.textContent = words;
    const key = `${now.number} ${now.calibration_id}`;
    if (told !== null && key !== told && now.calibration_id !== null) made(now.calibration_id);
    told = key;
  };
  const first = refresh();
  const timer = setInterval(refresh, EVERY_MS);
  return { first, leave: () => clearInterval(timer) };
}

// in a sentence
export function runWords({ state, sentence, reason, calibration_id }) {
  if (state === "ended") return `Not calibrated: ${reason}`;
  if (state === "calibrated") return `Calibration ${number(calibration_id)} is there.`;
  if (state === "fitting") return "All is measured; the curves are fitted.";
  const doing = { pausing: " It stands still after this trial.", paused: " It is paused, with the power off." }[state] ?? "";
  return sentence ? `${sentence}.${doing}` : "";
}
