// A campaign: a kind of experiment, what its experiments share, and what differs between them. Planned first, then queued.

import { get, post } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { Form } from "../ui/form.js";
import { duration, number, unitOf, withUnit } from "../ui/format.js";
import { titled, toShown } from "../ui/units.js";
import { Grid } from "./grid.js";

const ORDERS = [["as-given", "as given"], ["boustrophedon", "there and back"], ["random", "shuffled"]];

// queued(): a campaign was put into the queue
export async function campaignForm(place, live, queued) {
  const kinds = await attempt(place, async () => (await get("/experiment-kinds")).items);
  if (!kinds) return;
  const text = (id, value, more = {}) => h("input", { id, value, autocomplete: "off", ...more });
  const kind = h("select", { id: "campaign-kind" }, kinds.map((one) => h("option", { value: one.name }, one.title)));
  const [shared, varied, answer] = [h("div"), h("div"), h("div")];
  const name = text("campaign-name", "campaign");
  const repeats = text("campaign-repeats", "1", { inputMode: "numeric" });
  const order = h("select", { id: "campaign-order" }, ORDERS.map(([value, words]) => h("option", { value }, words)));
  const seed = text("campaign-seed", "1", { inputMode: "numeric" });
  const tags = text("campaign-tags", "", { placeholder: "separated by commas" });
  let form;
  let grid;
  const choose = () => {
    const { parameters } = kinds.find((one) => one.name === kind.value);
    form = new Form(parameters, "shared");
    grid = new Grid(parameters);
    replace(shared, form.element);
    replace(varied, grid.element);
  };
  const wanted = () => {
    const differing = grid.values();
    const parameters = Object.fromEntries(Object.entries(form.values()).filter(([key]) => !(key in differing)));
    const body = { name: name.value, kind: kind.value, parameters, grid: differing, repeats: Number(repeats.value), order: order.value, seed: Number(seed.value),
      tags: tags.value.split(",").map((one) => one.trim()).filter(Boolean) };
    return live.status?.simulated ? { ...body, pace: "fast" } : body;
  };
  const send = (path, shown) => async ({ currentTarget: button }) => {
    form.showProblems([], "parameters");
    const plan = await attempt(answer, () => refusedAtFields(form, () => post(path, wanted())), { button, busy: "Checking every experiment …" });
    if (plan) shown(plan);
  };
  const plan = h("button", { type: "button", onclick: send("/campaigns/plan", (found) => replace(answer, planned(found))) }, "Plan");
  // what is queued moves the joint when it is its turn: by this button alone, not by Enter in a field
  const start = h("button", { type: "button", class: "primary", onclick: send("/campaigns", (found) => {
    replace(answer, h("div", { class: "good", role: "status" }, `${found.item_ids.length} experiments are in the queue.`), planned(found));
    queued();
  }) }, "Put into the queue");
  kind.addEventListener("change", choose);
  choose();
  replace(place, h("form", { class: "form", onsubmit: (event) => event.preventDefault(), novalidate: true },
    h("div", { class: "row" }, h("label", { for: "campaign-name" }, "Name", name), h("label", { for: "campaign-kind" }, "What to do", kind)),
    h("fieldset", {}, h("legend", {}, "What differs: every combination is run"), varied),
    h("details", {}, h("summary", {}, "What all share"), shared),
    h("div", { class: "row" }, h("label", { for: "campaign-repeats" }, "Experiments of each combination", repeats), h("label", { for: "campaign-order" }, "Order", order),
      h("label", { for: "campaign-seed" }, "Seed of the shuffling", seed), h("label", { for: "campaign-tags" }, "Tags", tags)),
    h("div", { class: "row" }, plan, start), answer));
}

// what is wrong with a shared parameter is said at its field; the rest is thrown on
async function refusedAtFields(form, action) {
  try {
    return await action();
  } catch (error) {
    const elsewhere = form.showProblems(error.errors ?? [], "parameters");
    if (elsewhere.length) throw new Error(elsewhere.map((one) => `${one.field}: ${one.message}`).join("; "));
    throw error;
  }
}

function planned({ items, duration_s, load_changes: changes }) {
  const names = [...new Set(items.flatMap((one) => Object.keys(one.parameters)))];
  const differing = names.filter((key) => new Set(items.map((one) => JSON.stringify(one.parameters[key]))).size > 1);
  return [h("p", { class: "sentence", role: "status" }, `${items.length} experiments, about ${duration(duration_s)} of the joint's time; something is hung ${changes} ${changes === 1 ? "time" : "times"}.`),
    table("Plan of the campaign", [
      { title: "", unseen: "Place", number: true, cell: (one) => items.indexOf(one) + 1 },
      ...differing.map((key) => ({ title: withUnit(key), number: true, cell: (one) => [one.parameters[key]].flat().map((value) => (typeof value === "number" ? number(toShown(value, unitOf(key))) : number(value))).join(", ") })),
      { title: titled("Loads hung", "kg"), number: true, cell: (one) => one.loads_kg.map((load) => number(toShown(load, "kg"), 3)).join(", ") || "–" },
      { title: "About", number: true, cell: (one) => duration(one.duration_s) },
    ], items)];
}
