// The joint of the bench, moved by the rows as they are recorded.

import { get } from "../app/api.js";
import { JointDrawing } from "./drawing.js";

export function liveJoint(place, { live, state }, latest = null) {
  const drawing = new JointDrawing(place);
  const known = get("/bench").then((bench) => drawing.rig(rigOf(bench)), () => {});
  let pending = false;
  const draw = () => {
    pending = false;
    drawing.show(rowOf(live, state.now));
  };
  // once a frame, however often rows come
  const show = () => {
    if (pending || document.hidden) return;
    pending = true;
    requestAnimationFrame(draw);
  };
  const load = () => known.then(() => drawing.rig({ load_kg: latest.trials.at(-1)?.conditions.load_kg }));
  live.addEventListener("rows", show);
  state.addEventListener("change", show);
  latest?.addEventListener("change", load);
  show();
  return () => {
    live.removeEventListener("rows", show);
    state.removeEventListener("change", show);
    latest?.removeEventListener("change", load);
  };
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
