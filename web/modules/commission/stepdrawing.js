// The joint of a step: where the motor may bring the arm, where a hand is to bring it, and where it is while it moves.

import { JointDrawing } from "../joint/drawing.js";
import { eachFrame, rowOf } from "../joint/livejoint.js";

// the questions that ask for the arm to be somewhere: angle of the target
const BY_HAND = { down: 0, hand_angle_deg: Math.PI / 2, clear: 0 };

export function isPowered(step) {
  return step.low_rad !== step.high_rad;
}

export function stepDrawing(place, { live, state }) {
  const drawing = new JointDrawing(place, { label: "The joint of this step" });
  let [target, powered] = [NaN, false];
  const { soon, leave } = eachFrame({ live, state }, () => {
    const row = rowOf(live, state.now);
    // between motions nobody measures: the arm is drawn where the hand is to bring it
    if (state.now.running) drawing.show(row);
    else drawing.show({ position_rad: powered ? row.position_rad : NaN, target_rad: target, current_a: NaN, dimmed: true });
  });
  const show = (step, question) => {
    powered = isPowered(step);
    target = BY_HAND[question?.key] ?? NaN;
    drawing.rig({ position_min_rad: step.low_rad, position_max_rad: step.high_rad });
    soon();
  };
  return { show, leave };
}
