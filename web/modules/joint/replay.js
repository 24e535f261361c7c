// A trial seen again: the joint moves as it did, along the cursor of the chart; played, or pointed at.

import { get } from "../app/api.js";
import { h } from "../ui/dom.js";
import { JointDrawing } from "./drawing.js";
import { rigOf } from "./livejoint.js";

const LONGEST_S = 30; // a longer trial is played faster

// chart: tells where one points, and is told; limits(): of the trial [s]; at(time_s): what was measured then
export function replay(place, trial, { chart, limits, at }) {
  const drawing = new JointDrawing(place, { label: `The joint in trial ${trial.trial_id}` });
  const button = h("button", { type: "button" }, "Play");
  const [low, high] = limits();
  let [time_s, frame, last_ms] = [low, null, 0];
  const factor = Math.max(1, (high - low) / LONGEST_S);
  const show = (at_s) => {
    time_s = at_s;
    drawing.show(at(time_s));
  };
  const stop = () => {
    cancelAnimationFrame(frame);
    frame = null;
    button.textContent = "Play";
  };
  const step = (now_ms) => {
    const next_s = time_s + (factor * Math.min(100, now_ms - last_ms)) / 1000;
    last_ms = now_ms;
    if (next_s >= high) {
      chart.cursor = high;
      show(high);
      stop();
      return;
    }
    chart.cursor = next_s;
    show(next_s);
    frame = requestAnimationFrame(step);
  };
  button.addEventListener("click", () => {
    if (frame !== null) {
      stop();
      return;
    }
    if (time_s >= high) time_s = low;
    last_ms = performance.now();
    button.textContent = "Pause";
    frame = requestAnimationFrame(step);
  });
  chart.addEventListener("cursor", () => {
    if (chart.cursor === null) return;
    stop();
    show(chart.cursor);
  });
  Promise.all([get("/bench"), get(`/experiments/${trial.experiment_id}`)]).then(([bench, experiment]) => {
    drawing.rig({ ...rigOf(bench), play_rad: experiment.rig.gear?.backlash_rad, load_kg: trial.conditions.load_kg });
  }, () => {});
  place.append(h("div", { class: "row centre" }, button, h("span", { class: "hint" }, factor > 1 ? `${factor.toPrecision(2)} times as fast as it was` : "as fast as it was")));
  show(low);
  return stop;
}
