// The bench: start form, drive and limits, live plot.

import { get } from "./api.js";
import { facts, h, panel, replace } from "./dom.js";
import { startForm } from "./experiments.js";
import { nameOf, number } from "./format.js";
import { livePlot } from "./liveplot.js";
import { attempt } from "./problem.js";

export function benchView(place, { live }) {
  const start = h("div");
  const drive = h("div");
  const plot = h("div");
  replace(place, h("div", { class: "columns" },
    h("div", {}, panel("Start an experiment", start), panel("Drive and limits", drive)),
    h("div", {}, panel("Live", plot))));
  startForm(start, live);
  attempt(drive, async () => replace(drive, description(await get("/bench"))));
  return livePlot(plot, live);
}

function description(bench) {
  const { drive, limits } = bench;
  const identity = drive
    ? [["drive", [drive.vendor, drive.product].filter(Boolean).join(" ") || drive.device], ["firmware", drive.firmware || "not told"],
      ["modes", drive.modes.join(", ")], ["measures", drive.measured.map(nameOf).join(", ")], ["watchdog", `${number(drive.watchdog_s)} s`]]
    : [["drive", "not connected yet; it is opened when an experiment starts"]];
  return facts([...identity, ["rig", bench.rig.name], ...limits.map((limit) => [limit.description, `${number(limit.value)} ${limit.unit}`]), ["software", bench.software_version]]);
}
