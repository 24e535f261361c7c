// The joint of the bench, moved by the rows as they are recorded.

import { get } from "../app/api.js";
import { JointDrawing } from "./drawing.js";

export function liveJoint(place, { live, state }, latest = null) {
  const drawing = new JointDrawing(place);
  const known = get("/bench").then((bench) => drawing.rig(rigOf(bench)), () => {});
  const frames = eachFrame({ live, state }, () => drawing.show(rowOf(live, state.now)));
  const load = () => known.then(() => drawing.rig({ load_kg: latest.trials.at(-1)?.conditions.load_kg }));
  latest?.addEventListener("change", load);
  frames.soon();
  return () => {
    frames.leave();
    latest?.removeEventListener("change", load);
  };
}

// draws once a frame, however often rows come; soon(): draw anew, leave(): no more
export function eachFrame({ live, state }, draw) {
  let pending = false;
  const soon = () => {
    if (pending || document.hidden) return;
    pending = true;
    requestAnimationFrame(() => {
      pending = false;
      draw();
    });
  };
  live.addEventListener("rows", soon);
  state.addEventListener("change", soon);
  const leave = () => {
    live.removeEventListener("rows", soon);
    state.removeEventListener("change", soon);
  };
  return { soon, leave };
}

// what the drawing needs of GET /bench
export function rigOf(bench) {
  const limit = (name) => bench.limits.find((one) => one.name === name)?.value;
  return { position_min_rad: limit("position_min_rad"), position_max_rad: limit("position_max_rad"), current_a: limit("current_a"), heaviest_kg: limit("load_kg"),
    play_rad: bench.rig.gear?.backlash_rad };
}

// the newest row; before any came, the last reading
export function rowOf(live, { status, running, fresh }) {
  const last = (name) => live.rows.column(name)?.at(-1);
  const first = (...values) => values.find((value) => Number.isFinite(value));
  const reading = status?.reading ?? {};
  return { position_rad: first(last("position_rad"), reading.position_rad), target_rad: running ? last("target_rad") : NaN,
    current_a: running ? first(last("current_a"), last("current_estimate_a"), reading.current_a) : NaN, dimmed: !fresh || !running };
}
