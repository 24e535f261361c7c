// The line beside STOP: simulated or real, what the bench does, and whether what is shown is still true.

import { h, replace } from "../ui/dom.js";
import { number } from "../ui/format.js";

export function statusBar(place, live) {
  const show = () => replace(place, live.stale ? stale(live.status) : known(live.status));
  let shown = "";
  const changed = () => {
    const key = JSON.stringify([live.stale, live.status?.state, live.status?.run, live.status?.simulated]);
    if (key !== shown) show();
    shown = key;
  };
  live.addEventListener("status", changed);
  live.addEventListener("tick", changed);
  show();
}

function stale(status) {
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
