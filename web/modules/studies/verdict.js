// What a study has come to, in one sentence: the error before, what was added, the error now, and what is left of it.

import { interval, percent } from "../ui/format.js";

// ladder: as the service answers; model: the one that is shown
export function verdict({ rungs, floor }, model) {
  const now = rungs.find((one) => one.model_id === model) ?? rungs.at(-1);
  const first = rungs[0];
  const added = now.effects.filter((name) => !first.effects.includes(name));
  const error = interval(now.held_out, now.held_out_low, now.held_out_high);
  const best = floorOf(floor);
  const near = best !== null && now.held_out <= 1.2 * best;
  const left = best === null ? "" : ` Repeats alone differ by ${percent(best)}, as far as the best model can tell${near ? ": Diagnose says whether anything can be gained" : ""}.`;
  if (!added.length) return `The ${now.model_id === first.model_id ? "base " : ""}model is off by ${error} of the effort on trials that it was not fitted to.${left}`;
  return `With ${added.join(" and ").replaceAll("_", " ")} the error falls from ${percent(first.held_out)} to ${error} on trials that the model was not fitted to.${left}`
    .replace("the error falls", now.held_out < first.held_out ? "the error falls" : "the error does not fall, but goes");
}

export function floorOf(floor) {
  if (floor === null || floor === undefined) return null;
  return typeof floor === "number" ? floor : floor.relative;
}
