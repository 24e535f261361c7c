// One open study as steps: the verdict on top, the step that is shown, and beside it measured against predicted, which
// stays in view. Adding and dropping effects moves from model to model.

import { get, post, remove } from "../app/api.js";
import { attempt, patiently, together } from "../ui/attempt.js";
import { h, panel, replace, table } from "../ui/dom.js";
import { withFiles } from "../ui/files.js";
import { conditions, spoken } from "../ui/format.js";
import { beforeAfter } from "./beforeafter.js";
import { comparison } from "./comparison.js";
import { diagnosis } from "./diagnosis.js";
import { ladderPlot, rungName } from "./ladder.js";
import { Linked } from "./linked.js";
import { parameterTables } from "./parameters.js";
import { searchButton } from "./search.js";
import { SeriesPlot } from "./seriesplot.js";
import { modelButtons } from "./modelfile.js";
import { Steps } from "./steps.js";
import { suggestions } from "./suggestions.js";
import { verdict } from "./verdict.js";

const NAMES = ["head", "undo", "verdict", "steps", "record", "compare", "diagnose", "add", "result", "series", "model", "change", "ladder", "parameters", "search", "suggested", "diagnosed"];

export function studyView(place, [id, step], query) {
  const parts = Object.fromEntries(NAMES.map((name) => [name, h("div")]));
  const study = new Study(id, parts, { step, model: Number(query.model) || null });
  together(place, [study.open(place)]);
  return () => study.close();
}

class Study {
  constructor(id, parts, wanted) {
    Object.assign(this, { id, parts, wanted, path: `/studies/${encodeURIComponent(id)}`, model: null, compared: null, linked: null });
  }

  close() {
    this.linked?.close();
    this.linked = null;
  }

  // told(): what is to be said once the study is there, before anything is fitted: later it would take the reader away
  async open(place, told) {
    const answer = h("div");
    if (place) replace(place, answer);
    const study = await attempt(answer, () => get(this.path));
    if (!study) {
      answer.append(h("p", {}, h("a", { href: "#study" }, "All studies")));
      return;
    }
    this.study = study;
    if (place) this.#layOut(place);
    replace(this.parts.head, heading(study, this.path, this.parts.undo));
    this.#record();
    told?.();
    const wanted = this.wanted.model;
    const known = !wanted || (await get(`${this.path}/ladder`)).rungs.some((one) => one.model_id === wanted);
    await this.select(wanted && known ? wanted : study.model_id);
    if (!known) replace(this.parts.change, h("div", { class: "problem", role: "alert" }, `Study ${this.id} has no model ${wanted}; the newest is shown.`));
    this.wanted = {};
  }

  async select(model_id) {
    this.model = model_id;
    this.steps.say();
    this.askDiagnosis();
    this.comparing = this.showComparison();
    await Promise.all([this.showLadder(), this.comparing]);
  }

  async showLadder() {
    const ladder = await patiently(this.parts.ladder, "ladder", "Reading the models …", (signal, job) => get(`${this.path}/ladder`, {}, { signal, job }));
    if (!ladder) return;
    const rung = ladder.rungs.find((one) => one.model_id === this.model);
    this.parts.verdict.textContent = verdict(ladder, this.model);
    replace(this.parts.model, this.modelChoice(ladder), this.chips(rung));
    replace(this.parts.undo, this.undoButton(ladder, rung));
    ladderPlot(this.parts.ladder, ladder, this.model);
  }

  async showComparison() {
    const model_id = this.model;
    const compared = await patiently(this.parts.compare, "compare", "Fitting, and comparing with every trial …", (signal, job) => get(`${this.path}/compare`, { model_id }, { signal, job }));
    if (!compared || model_id !== this.model) return;
    this.compared = compared;
    this.linked?.close();
    this.linked = new Linked(this.path, new SeriesPlot(this.parts.series, compared));
    replace(this.parts.parameters, parameterTables(compared), modelButtons(this.study, compared));
    this.mapped = comparison(this.parts.compare, compared, { path: this.path, linked: this.linked });
  }

  askDiagnosis() {
    const { diagnosed, diagnose } = this.parts;
    const known = `diagnosed ${this.path} ${this.model}`; // in this tab: whoever loads the page anew has it again
    const button = h("button", { class: "primary", type: "button", id: "diagnose-now" }, "Diagnose");
    replace(diagnosed);
    button.addEventListener("click", async () => {
      const found = await patiently(diagnosed, "diagnose", "Testing every effect of the catalogue …", (signal, job) => get(`${this.path}/diagnose`, { model_id: this.model }, { signal, job }), { button });
      await this.comparing; // its plots show where effects act
      if (found) sessionStorage.setItem(known, "");
      if (found) diagnosis(diagnosed, found, { add: (effect, place) => this.add(effect, place), finish: await this.finish(), path: this.path, linked: this.linked, effort: this.study.effort });
    });
    replace(diagnose, panel("What is missing?", h("p", { class: "soft" }, "Which physical effect does the model lack, how sure is that, and what would adding it bring?"), h("div", { class: "row centre" }, button), diagnosed));
    searchButton(this.parts.search, this.path, () => this.model, (model_id, tell) => this.searched(model_id, tell));
    if (this.wanted.step === "diagnose" && sessionStorage.getItem(known) !== null) button.click();
  }

  // what to press where nothing is left to add: of the joint of a challenge, one is told what was hidden
  async finish() {
    const made = await get("/challenges").catch(() => ({ items: [] }));
    const challenge = made.items.find((one) => one.experiment_id === this.experiment?.experiment_id);
    return [challenge && h("a", { class: "button primary", href: `#learn/challenge/${challenge.challenge_id}` }, "Guess and reveal"),
      h("button", { type: "button", class: challenge ? "" : "primary", onclick: () => this.steps.show("result") }, "See the result")];
  }

  async extended(sentence) {
    await this.open(null, () => this.told(h("div", { class: "good", role: "status" }, sentence)));
  }

  async searched(model_id, tell) {
    await this.select(model_id);
    tell(this.parts.change);
    this.steps.show("add");
  }

  told(...words) {
    replace(this.parts.change, ...words);
    this.steps.show("add");
  }

  add(effect, place) {
    const body = { effect, model_id: this.model };
    return this.fitted(place, body);
  }

  async fitted(place, body) {
    const result = await patiently(place, "fit", "Fitting …", (signal, job) => post(`${this.path}/models`, body, 0, { signal, job }));
    if (result) await attempt(place, () => this.changed(result));
  }

  drop(effect) {
    const body = { effect, model_id: this.model, action: "drop" };
    return this.fitted(this.parts.change, body);
  }

  async changed(result) {
    const before = this.compared?.model_id === result.parent_id ? this.compared : await get(`${this.path}/compare`, { model_id: result.parent_id });
    this.told(h("div", { class: "good", role: "status" }, spoken(result.sentence)));
    await this.select(result.model_id);
    if (this.compared?.model_id !== result.model_id) return;
    beforeAfter(this.parts.change, result, { undo: () => this.undo(result.parent_id) });
    this.linked.series.compareWith(before, this.compared);
  }

  // back to the model before; the one that is left was made by the last change, and nothing was made from it
  undo(parent_id, rung = null) {
    return attempt(this.parts.change, async () => {
      const left = this.model;
      this.model = null; // a comparison of it that is still under way is not shown, and asks nothing more of it
      try {
        await this.comparing;
        await this.mapped;
        await remove(`${this.path}/models/${left}`);
      } catch (error) {
        this.model = left;
        throw error;
      }
      replace(this.parts.change, rung && h("p", { role: "status" }, `Undone: model ${rungName(rung)}. `, this.redoButton(parent_id, rung)));
      await this.select(parent_id);
    });
  }

  redoButton(model_id, { added, removed }) {
    const body = { effect: added ?? removed, model_id, action: added ? "add" : "drop" };
    return h("button", { type: "button", class: "small", onclick: () => this.fitted(this.parts.change, body) }, "Redo");
  }

  // of the last change that made the shown model; null where another model was made from it, or it is the first
  undoButton({ rungs }, rung) {
    if (!rung?.parent_id || rungs.some((one) => one.parent_id === rung.model_id)) return null;
    const undo = async () => {
      this.steps.show("add");
      await this.undo(rung.parent_id, rung.added || rung.removed ? rung : null);
    };
    return h("button", { type: "button", class: "small", onclick: undo }, `Undo ${rungName(rung).split(": ")[1]}`);
  }

  chips(rung) {
    const chip = (name) => h("span", { class: "chip" }, name.replaceAll("_", " "),
      h("button", { type: "button", title: `Drop ${name}`, "aria-label": `Drop ${name}`, onclick: () => this.drop(name) }, "×"));
    return h("div", { role: "group", "aria-label": "Effects of this model" }, (rung?.effects ?? []).map(chip));
  }

  modelChoice(ladder) {
    const options = ladder.rungs.map((rung) => h("option", { value: String(rung.model_id), selected: rung.model_id === this.model }, rungName(rung)));
    const choice = h("select", { id: "model", onchange: (event) => this.select(Number(event.target.value)) }, options);
    return h("div", { class: "row" }, h("label", { for: "model" }, "Shown model", choice),
      ladder.rungs.length > 1 && h("a", { class: "button", href: `#compare/${this.id}.${ladder.rungs[0].model_id}/${this.id}.${this.model}` }, "Beside another model or study"));
  }

  #layOut(place) {
    const { parts } = this;
    parts.diagnosed.className = "diagnosed";
    parts.change.className = "study-change";
    replace(parts.add, panel("Model", parts.model, parts.change, h("h3", {}, "Search by itself"), parts.search));
    replace(parts.result, panel("Ladder: the error from model to model", parts.ladder), panel("Parameters", parts.parameters));
    const shown = h("div", { class: "study-steps" }, parts.record, parts.compare, parts.diagnose, parts.add, parts.result);
    replace(place, h("section", { class: "panel study-head" }, parts.head, h("p", { class: "sentence", role: "status" }, parts.verdict), parts.steps),
      h("div", { class: "study" }, shown, h("div", { class: "study-plots" }, panel("Measured against predicted", parts.series))));
    const address = (step) => ({ view: "study", rest: [this.id, step], query: { model: this.model && this.model !== this.study.model_id ? this.model : "" } });
    this.steps = new Steps(parts.steps, parts, { address, first: this.wanted.step });
  }

  #record() {
    const { record, suggested } = this.parts;
    replace(record, panel("Trials of this study", trialTable(this.study)), panel("What to record next", suggested));
    this.#offerSuggestions(suggested);
  }

  // only the joint of this bench can be recorded again: trials that came in from elsewhere are of another one. It is asked
  // once: what was pressed of an earlier offer while that is asked again would have its answer taken away
  async #offerSuggestions(place) {
    if (this.experiment === undefined) {
      const first = await get(`/trials/${this.study.trials[0].trial_id}`).catch(() => null);
      this.experiment = first && (await get(`/experiments/${first.experiment_id}`).catch(() => null));
    }
    if (this.experiment?.source === "imported") {
      replace(place, h("p", { class: "soft" }, "These trials were imported, or are those of a challenge: their joint does not stand on this bench, so nothing more can be recorded of it here."));
    } else suggestions(place, this.path, () => this.model, (sentence) => this.extended(sentence));
  }
}

const MANY = 12; // trials: as a list they would push what can be done about them off the screen

function trialTable(study) {
  const list = trialList(study);
  return study.trials.length > MANY ? h("details", {}, h("summary", {}, `${study.trials.length} trials`), list) : list;
}

function trialList(study) {
  return table("Trials of the study", [
    { title: "Trial", number: true, cell: (one) => h("a", { href: `#trials/${one.trial_id}` }, String(one.trial_id)) },
    { title: "Name", cell: (one) => one.name },
    { title: "Role", cell: (one) => one.role.replace("_", "-") },
    { title: "Conditions", cell: (one) => conditions(one.conditions) },
  ], study.trials);
}

function heading(study, path, undo) {
  const count = (role) => study.trials.filter((trial) => trial.role === role).length;
  const held = count("held_out") ? `${count("held_out")} held out` : "each left out in turn to judge";
  return h("div", { class: "row centre between" }, h("div", {}, h("h2", {}, `Study ${study.study_id}: ${study.name}`),
    h("p", { class: "soft" }, `${count("training")} training trials, ${held}. Effort: ${study.effort.name} [${study.effort.unit}]. `,
      h("a", { href: "#study" }, "All studies"))), h("div", { class: "row centre" }, undo, withFiles([], [["Report", `Report of study ${study.study_id}`, `${path}/report`, `study-${study.study_id}.html`, "report"]])));
}
