// The queue and campaigns: many experiments, one after the other.

import { benchesPanel } from "./benches.js";
import { campaignForm } from "./campaign.js";
import { together } from "../ui/attempt.js";
import { h, panel, replace } from "../ui/dom.js";
import { leasePanel } from "../bench/lease.js";
import { queuePanel } from "./queue.js";

export function queueView(place, { live }) {
  const [lease, list, form, benches] = [h("div"), h("div"), h("div"), h("div")];
  replace(place, panel("Queue", h("p", { class: "soft" }, "Experiments run in this order. STOP, and whatever does not complete, holds the queue until somebody lets it go on."), lease, h("div", { class: "gap" }), list),
    panel("Campaign", h("p", { class: "soft" }, "One kind of experiment under every combination of some conditions. Loads are changed as seldom as possible."), form), benches);
  const queue = queuePanel(list, { whole: true });
  together(place, [queue.first, campaignForm(form, live, () => queue.refresh())]);
  const leaveLease = leasePanel(lease, live);
  const leaveBenches = benchesPanel(benches);
  return () => {
    queue.leave();
    leaveLease();
    leaveBenches();
  };
}
