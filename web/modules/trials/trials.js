// Trials: experiments, their trials, plots, files; the paper's figures; recording sets in and out. What is looked for and
// what is plotted stand in the address: #trials/17,18?experiment=3&words=load&sort=name&page=2

import { note, written } from "../app/address.js";
import { get } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { h, panel, replace } from "../ui/dom.js";
import { presets } from "../ui/presets.js";
import { calibrations } from "./calibrations.js";
import { experimentList } from "./experimentlist.js";
import { figureOf } from "./figures.js";
import { importForm } from "./recordingsets.js";
import { offsetMin, sessionStrip } from "./sessions.js";
import { trialPlot } from "./trialplot.js";
import { trialTable } from "./trialtable.js";

const EACH = 25;
const OF_A_FIGURE = 1000;
const SETTLED_MS = 250;
const OUTCOMES = ["", "completed", "stopped", "tripped", "failed", "interrupted", "refused", "running"];
const UNITS = /^(g|kg|°|rad|rad\/s|°\/s|A|s)$/;

export function trialsView(place, { rest, query }) {
  const [experiments, list, detail, figure, curves, strip, kept] = ["div", "div", "div", "div", "div", "div", "div"].map((tag) => h(tag));
  let asked = { experiment: query.experiment ?? "", outcome: query.outcome ?? "", words: query.words ?? "", day: query.day ?? "", sort: query.sort ?? "", page: Number(query.page) || 1 };
  let ids = idsOf(rest);
  let [plotted, figured, timer, drawStrip] = [null, null, null, () => {}];
  const chosen = new Set();
  const address = () => ({ view: "trials", rest: ids.length ? [ids.join(",")] : [], query: { ...asked, page: asked.page > 1 ? asked.page : "" } });
  const say = (step) => note(address(), { step });
  const plot = async (wanted) => {
    plotted?.close();
    ids = wanted;
    say(true);
    plotted = await trialPlot(detail, ids);
  };
  const turn = (change) => {
    asked = { ...asked, page: 1, ...change };
    say(true);
    return show();
  };
  const show = () => attempt(list, async () => {
    const found = await get("/trials/search", wordsOf(asked));
    trialTable(list, found, { asked, chosen, plot, turn, each: EACH });
    drawStrip();
    await showFigure();
  });
  const showFigure = async () => {
    if (figured === asked.experiment) return;
    figured = asked.experiment;
    const trials = asked.experiment ? (await get("/trials", { experiment_id: asked.experiment, limit: OF_A_FIGURE })).items : [];
    await figureOf(figure, kindOf(trials), trials);
  };
  const words = h("input", { type: "search", id: "trial-search", value: asked.words, placeholder: "name, kind, condition …", oninput: () => {
    clearTimeout(timer);
    timer = setTimeout(() => turn({ words: words.value.trim() }), SETTLED_MS);
  } });
  const number = h("input", { inputMode: "numeric", placeholder: "all", value: asked.experiment, onchange: () => turn({ experiment: number.value.trim() }) });
  const outcome = h("select", { onchange: () => turn({ outcome: outcome.value }) }, OUTCOMES.map((name) => h("option", { value: name, selected: name === asked.outcome }, name || "any")));
  const bar = h("div", { class: "row" }, h("label", {}, "Experiment", number), h("label", { for: "trial-search" }, "Search", words), h("label", {}, "Outcome", outcome));
  const choose = (id) => {
    number.value = String(id);
    return turn({ experiment: String(id) });
  };
  const { refresh: listAgain } = experimentList(experiments, choose);
  const imported = importForm(async (made) => {
    await listAgain();
    await choose(made.experiment_id);
  }, rest[0] === "import");
  replace(place, panel("Experiments", imported, experiments), panel("Trials", strip, bar, kept, h("div", { class: "gap" }), list), detail, figure, curves);
  const friction = calibrations(curves);
  presets(kept, "trials", () => written({ ...address(), rest: [] }), (hash) => { location.hash = hash; });
  const strips = attempt(strip, async () => { drawStrip = await sessionStrip(strip, () => asked.day, (day) => turn({ day })); });
  together(place, [listAgain(), show(), friction.first, strips]);
  if (ids.length) trialPlot(detail, ids).then((made) => { plotted = made; });
  return () => {
    clearTimeout(timer);
    friction.leave();
    plotted?.close();
  };
}

// numbers of trials in an address, such as "17,18"
export function idsOf([part = ""]) {
  return part.split(",").filter((text) => /^\d+$/.test(text)).map(Number);
}

// an address's words -> what the service is asked for
export function wordsOf({ experiment, outcome, words, day = "", sort, page }) {
  const [, down, name] = /^(-?)(\w*)$/.exec(sort) ?? [];
  const text = words.split(/\s+/).filter((word) => !UNITS.test(word)).map((word) => word.replace(/°$/, "")).join(" ");
  return { experiment_id: experiment, outcome, words: text, ...(day ? { day, offset_min: offsetMin() } : {}), sort: name || "trial", descending: !name || down === "-", limit: EACH, offset: EACH * (page - 1) };
}

// of all of them, whatever they came in by
function kindOf(trials) {
  const kinds = new Set(trials.map((trial) => trial.kind));
  return kinds.size === 1 ? [...kinds][0] : null;
}
