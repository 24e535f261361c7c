// Starting an experiment: choose a kind, fill in the form that its schema gives, see what would move, start. Only the
// Start button moves the joint; Enter in a field does not.

import { here, note, written } from "../app/address.js";
import { get, post, token } from "../app/api.js";
import { attempt, problemBox } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";
import { Form } from "../ui/form.js";
import { duration } from "../ui/format.js";
import { presets } from "../ui/presets.js";
import { withShownUnit } from "../ui/units.js";

const PLAN_AFTER_MS = 300; // of quiet in the fields

// queued(): something was put into the queue; begun(): an experiment has started
export async function startForm(place, live, queued, begun) {
  const kinds = await attempt(place, async () => (await get("/experiment-kinds")).items);
  if (!kinds) return;
  const asked = here().query;
  const choice = h("select", { id: "kind" }, kinds.map((kind) => h("option", { value: kind.name, selected: kind.name === asked.kind }, kind.title)));
  const [summary, parameters, motion, answer] = [h("p", { class: "soft" }), h("div"), h("p", { class: "motion", id: "motion", role: "status" }), h("div")];
  const further = furtherFields();
  const button = h("button", { type: "button", class: "primary", "aria-describedby": "motion" }, "Start");
  const later = h("button", { type: "button" }, "Queue");
  let [form, timer, started] = [null, null, null];

  const wanted = () => ({ kind: choice.value, parameters: form.values(), ...further.values(live.status?.simulated) });
  const plan = async () => {
    clearTimeout(timer);
    replace(motion);
    if (!form.check()) {
      replace(motion, "Something is marked above: nothing can be started yet.");
      return null;
    }
    if (!token.get()) return undefined; // the service says at the start itself that it takes one
    try {
      const found = await post("/experiments/plan", wanted());
      replace(motion, motionWords(found, live.status?.simulated));
      return found;
    } catch (error) {
      const elsewhere = form.showProblems(error.errors ?? [], "parameters");
      const marked = error.errors?.length && !elsewhere.length;
      replace(motion, error.status === 401 ? "" : marked ? "Not possible on this bench: see the marked field." : error.message);
      return error.status === 401 ? undefined : null;
    }
  };
  const soon = () => {
    clearTimeout(timer);
    timer = setTimeout(plan, PLAN_AFTER_MS);
  };
  const choose = () => {
    const kind = kinds.find((one) => one.name === choice.value);
    form = new Form(kind.parameters, "parameter", soon);
    form.fill(valuesOf(here().query, kind.name));
    summary.textContent = kind.summary;
    replace(parameters, form.element);
    soon();
  };
  // one at a time: what is said of the second would be written over by the answer to the first
  const alone = async (...order) => {
    button.disabled = later.disabled = true;
    await send(...order);
    button.disabled = later.disabled = false;
  };
  const send = async (path, body, told) => {
    replace(answer);
    if ((await plan()) === null) {
      const marked = form.element.querySelector("[aria-invalid=true]");
      const where = marked ? "See what is marked." : "The reason stands above.";
      replace(answer, problemBox(new Error(`Not started, nothing has moved, nothing is recorded. ${where}`)));
      marked?.closest(".field").scrollIntoView({ block: "nearest" });
      return;
    }
    const done = await attempt(answer, () => post(path, body()));
    if (!done) return;
    started = done.experiment_id ?? null;
    replace(answer, h("div", { class: "good", role: "status" }, told(done)));
    queued();
    if (started !== null) begun();
  };
  // true for as long as it runs
  live.addEventListener("status", () => {
    const run = live.status?.run;
    if (started === null || run?.experiment_id !== started || run.outcome === "running") return;
    started = null;
    replace(answer);
  });
  button.addEventListener("click", () => alone("/experiments", wanted, (done) => `Experiment ${done.experiment_id} has started.`));
  later.addEventListener("click", () => alone("/queue", () => ({ items: [wanted()] }), () => "It is in the queue; it starts when it is its turn."));
  choice.addEventListener("change", () => {
    note({ view: "bench", query: { kind: choice.value } });
    choose();
  });
  document.addEventListener("token-set", soon);
  choose();
  const kept = h("div");
  presets(kept, "bench", () => written({ view: "bench", query: { kind: choice.value, ...form.values() } }), (hash) => { location.hash = hash; });
  replace(place, h("form", { class: "form", onsubmit: (event) => { event.preventDefault(); plan(); }, novalidate: true },
    h("label", { for: "kind" }, "What to do", choice), summary, kept, parameters, further.element,
    h("div", { class: "start" }, motion, h("div", { class: "row" }, button, later), answer)));
}

function furtherFields() {
  const operator = h("input", { id: "operator", autocomplete: "name" });
  const note_ = h("input", { id: "note", autocomplete: "off" });
  const tags = h("input", { id: "tags", autocomplete: "off", placeholder: "separated by commas" });
  const pace = h("input", { type: "checkbox", id: "fast" });
  const element = h("details", {}, h("summary", {}, "Operator, note, tags, pace"),
    h("div", { class: "form" },
      h("label", { for: "operator" }, "Operator", operator), h("label", { for: "note" }, "Note", note_), h("label", { for: "tags" }, "Tags", tags),
      h("label", { class: "inline" }, pace, "as fast as the computer can (simulated drive only)")));
  const values = (simulated) => ({ operator: operator.value, note: note_.value, tags: tags.value.split(",").map((one) => one.trim()).filter(Boolean),
    ...(simulated ? { pace: pace.checked ? "fast" : "real-time" } : {}) });
  return { element, values };
}

// parameters that an address names: #bench?kind=steps&repeats=2, in SI
function valuesOf({ kind, ...query }, name) {
  if (kind !== name) return {};
  return Object.fromEntries(Object.entries(query).map(([key, text]) => {
    const values = text.split(",").map((one) => (one !== "" && Number.isFinite(Number(one)) ? Number(one) : one));
    return [key, values.length > 1 ? values : values[0]];
  }));
}

// what Start moves, how far, for how long
export function motionWords({ trials, duration_s, angles_rad, position_limits_rad: limits, speed_rad_s, loads_kg, balanced }, simulated) {
  const angle = (value) => withShownUnit(value, "rad", 3);
  const [low, high] = [Math.min(0, ...angles_rad), Math.max(0, ...angles_rad)];
  const way = angles_rad.length && low !== high ? `between ${angle(low)} and ${angle(high)}` : `within ${angle(limits[0])} to ${angle(limits[1])}`;
  const speed = speed_rad_s === null ? "" : `, up to ${withShownUnit(speed_rad_s, "rad/s", 3)}`;
  const load = loads_kg.length ? ` Load: ${loads_kg.map((one) => withShownUnit(one, "kg", 3)).join(", ")}${balanced ? ", balanced arm" : ""}.` : "";
  return `Start moves the ${simulated ? "simulated " : ""}joint ${way}${speed}: ${trials} ${trials === 1 ? "trial" : "trials"}, about ${duration(duration_s)}.${load}`;
}
