// The benches of the laboratory, where there is one: what each does, who has it, and what it has not handed in yet; and what
// waits for whichever of them fits.

import { get } from "../app/api.js";
import { h, panel, replace, table } from "../ui/dom.js";
import { conditions, duration } from "../ui/format.js";

const PERIOD_MS = 5000;

const COLUMNS = [
  { title: "Bench", cell: ({ name, host }) => `${name} (${host})` },
  { title: "State", cell: ({ state, doing }) => (state === "lost" || !doing ? state : doing) },
  { title: "Lease", cell: ({ lease }) => lease || "free" },
  { title: "Queue", cell: ({ queue }) => queue || "empty" },
  { title: "To hand in", number: true, cell: ({ waiting }) => waiting },
  { title: "Heard of", cell: ({ silent_s }) => `${duration(silent_s)} ago` },
];

const ITEMS = [
  { title: "Experiment", cell: ({ item_id: number, kind, parameters }) => [`${number}: ${kind}`, h("div", { class: "hint" }, conditions(parameters))] },
  { title: "For", cell: (one) => [one.for_bench, one.for_rig, ...one.for_tags].filter(Boolean).join(", ") || "any bench" },
  { title: "State", cell: ({ state, bench }) => (bench ? `${state}: ${bench}` : state) },
  { title: "Declined", cell: ({ declined }) => Object.entries(declined).map(([bench, why]) => h("div", { class: "hint" }, `${bench}: ${why}`)) },
];

export function benchesPanel(place) {
  const show = async () => {
    const found = await get("/benches").catch(() => null);
    if (!found?.where) return;
    replace(place, panel("Benches of the laboratory",
      found.problem && h("p", { role: "status" }, `Not reached: ${found.problem}. ${found.waiting} experiments wait here to be handed in.`),
      table("Benches", COLUMNS, found.benches),
      found.queue.length > 0 && [h("h3", {}, "Queue of the laboratory"), table("Queue of the laboratory", ITEMS, found.queue)]));
  };
  show();
  const timer = setInterval(show, PERIOD_MS);
  return () => clearInterval(timer);
}
