// The benches of the laboratory, where there is one: what each does, who has it, and what it has not handed in yet.

import { get } from "../app/api.js";
import { h, panel, replace, table } from "../ui/dom.js";

const PERIOD_MS = 5000;

const COLUMNS = [
  { title: "Bench", cell: ({ name, host }) => `${name} (${host})` },
  { title: "State", cell: ({ state, doing }) => (state === "lost" || !doing ? state : doing) },
  { title: "Lease", cell: ({ lease }) => lease || "free" },
  { title: "Queue", cell: ({ queue }) => queue || "empty" },
  { title: "To hand in", number: true, cell: ({ waiting }) => waiting },
  { title: "Heard of", cell: ({ silent_s }) => `${Math.round(silent_s)} s ago` },
];

export function benchesPanel(place) {
  const show = async () => {
    const found = await get("/benches").catch(() => null);
    if (!found?.where) return;
    replace(place, panel("Benches of the laboratory",
      found.problem && h("p", { role: "status" }, `Not reached: ${found.problem}. ${found.waiting} experiments wait here to be handed in.`),
      table("Benches", COLUMNS, found.benches)));
  };
  show();
  const timer = setInterval(show, PERIOD_MS);
  return () => clearInterval(timer);
}
