// The bench: start form, drive and limits, live plot.

import { get } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { facts, h, panel, replace } from "../ui/dom.js";
import { nameOf, number } from "../ui/format.js";
import { faultPanel } from "./fault.js";
import { leasePanel } from "./lease.js";
import { livePlot } from "./liveplot.js";
import { withShownUnit } from "../ui/units.js";
import { queuePanel } from "../queue/queue.js";
import { startForm } from "./start.js";

const LEAST_SEEN_PX = 200; // of a panel that is in view

export function benchView(place, bench) {
  const { live, state } = bench;
  const [start, lease, queue, drive, fault, plot] = ["div", "div", "div", "div", "div", "div"].map((tag) => h(tag));
  replace(place, h("div", { class: "columns" }, panel("Start an experiment", lease, h("div", { class: "gap" }), start), h("div", { class: "wide" }, panel("Live", plot)),
    panel("Queue", queue), panel("Drive and limits", drive, fault, bench.links)));
  const waiting = queuePanel(queue);
  const form = startForm(start, live, () => waiting.refresh(), () => bringIntoSight(plot.closest(".panel")));
  const refresh = () => attempt(drive, async () => replace(drive, description(await get("/bench"))));
  let shown = live.status?.run?.experiment_id;
  const changed = () => {
    if (live.status?.run?.experiment_id === shown) return;
    shown = live.status?.run?.experiment_id;
    refresh();
  };
  live.addEventListener("status", changed);
  together(place, [form, refresh()]);
  const leave = livePlot(plot, bench);
  const leaveLease = leasePanel(lease, live);
  const leaveFault = faultPanel(fault, live);
  return () => {
    leaveLease();
    leaveFault();
    waiting.leave();
    live.removeEventListener("status", changed);
    leave();
  };
}

// on a narrow screen the picture of what moves stands far below the form
export function bringIntoSight(one) {
  const { top, bottom } = one.getBoundingClientRect();
  const seen = Math.min(bottom, innerHeight) - Math.max(top, 0);
  if (seen >= Math.min(LEAST_SEEN_PX, bottom - top)) return;
  one.scrollIntoView({ block: "start", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "instant" : "smooth" });
}

function description(bench) {
  const { drive, limits } = bench;
  const identity = drive
    ? [["drive", [drive.vendor, drive.product].filter(Boolean).join(" ") || drive.device], ["firmware", drive.firmware || "not told"],
      ["modes", drive.modes.join(", ")], ["measures", drive.measured.map(nameOf).join(", ")], ["watchdog", drive.watchdog_s === null ? "none: it does not stop by itself" : `${number(drive.watchdog_s)} s, ${drive.watchdog}`],
      ...drive.notes.map((note) => ["note", note])]
    : [["drive", "opens at the first start"]];
  return facts([...identity, ["rig", bench.rig.name], ...limits.map((limit) => [limit.description, withShownUnit(limit.value, limit.unit)]), ["software", bench.software_version]]);
}
