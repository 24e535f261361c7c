// The line beside STOP: simulated or real, what the bench does, and whether what is shown is still true.

import { h, replace } from "../ui/dom.js";
import { number } from "../ui/format.js";

export function statusBar(place, state) {
  let shown = "";
  const show = () => {
    const now = state.now;
    // the seconds are counted in the title alone: a screen reader need not hear each of them
    const key = JSON.stringify([now.fresh, now.status?.state, now.status?.run, now.status?.simulated]);
    if (key !== shown) replace(place, now.fresh ? known(now.status) : stale(now));
    if (!now.fresh) place.title = `No news for ${Math.round(now.silent_s)} s; trying again in ${Math.ceil(now.retry_s)} s`;
    else place.removeAttribute("title");
    shown = key;
  };
  state.addEventListener("change", show);
  show();
}

function stale({ status }) {
  const text = status ? "STALE: no news from the service, what you see is old" : "connecting …";
  return h("span", { class: "badge stale" }, text);
}

function known(status) {
  const simulated = status.simulated
    ? h("span", { class: "badge simulated", title: "No hardware moves: the drive is simulated" }, "SIMULATED")
    : h("span", { class: "badge real", title: "A real drive: the joint moves" }, "REAL DRIVE");
  return [simulated, h("span", { class: `badge ${status.state}` }, status.state), h("span", { class: "doing", title: doing(status.run) }, doing(status.run))];
}

function doing(run) {
  if (!run) return "nothing has run yet";
  const what = `${run.kind}, experiment ${run.experiment_id}`;
  if (run.outcome !== "running") return `${what}: ${run.outcome}${run.reason ? ` (${run.reason})` : ""}`;
  return `${what}, trial ${run.trial_index + 1} of ${run.trial_count}, ${number(Math.round(100 * run.progress))} %`;
}
