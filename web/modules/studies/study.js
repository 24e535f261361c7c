// One open study: ladder, comparison, diagnosis; adding and dropping effects moves from model to model.

import { get, post, remove } from "../app/api.js";
import { attempt, together } from "../ui/attempt.js";
import { beforeAfter } from "./beforeafter.js";
import { comparison } from "./comparison.js";
import { diagnosis } from "./diagnosis.js";
import { h, panel, replace } from "../ui/dom.js";
import { withFiles } from "../ui/files.js";
import { ladderPlot, rungName } from "./ladder.js";
import { searchButton } from "./search.js";
import { suggestions } from "./suggestions.js";

export function studyView(place, id) {
  const parts = Object.fromEntries(["head", "model", "change", "ladder", "compared", "diagnosed"].map((name) => [name, h("div")]));
  replace(place, parts.head, panel("Model", parts.model, parts.change), panel("Ladder: the error from model to model", parts.ladder),
    panel("What is missing?", parts.diagnosed), parts.compared);
  const study = new Study(id, parts);
  together(place, [study.open()]);
  return () => study.close();
}

class Study {
  #plots = [];

  constructor(id, parts) {
    this.path = `/studies/${encodeURIComponent(id)}`;
    this.parts = parts;
    this.model = null;
    this.compared = null;
  }

  close() {
    for (const plot of this.#plots) plot.close();
    this.#plots = [];
  }

  async open() {
    const study = await attempt(this.parts.head, () => get(this.path));
    if (!study) return;
    replace(this.parts.head, heading(study, this.path));
    await this.select(study.model_id);
  }

  async select(model_id) {
    this.model = model_id;
    this.askDiagnosis();
    await Promise.all([this.showLadder(), this.showComparison()]);
  }

  async showLadder() {
    const ladder = await attempt(this.parts.ladder, () => get(`${this.path}/ladder`));
    if (!ladder) return;
    const rung = ladder.rungs.find((one) => one.model_id === this.model);
    replace(this.parts.model, this.chips(rung), this.modelChoice(ladder));
    await ladderPlot(this.parts.ladder, ladder, this.model);
  }

  async showComparison() {
    const model_id = this.model;
    const compared = await attempt(this.parts.compared, () => get(`${this.path}/compare`, { model_id }), { busy: "Fitting …" });
    if (!compared || model_id !== this.model) return;
    this.compared = compared;
    this.#plots.push(await comparison(this.parts.compared, compared, this.path));
  }

  askDiagnosis() {
    const [answer, search, suggested] = [h("div"), h("div", { class: "row centre" }), h("div")];
    const button = h("button", { class: "primary", type: "button" }, "Diagnose");
    button.addEventListener("click", async () => {
      const busy = "Testing every effect of the catalogue …";
      const found = await attempt(answer, () => get(`${this.path}/diagnose`, { model_id: this.model }), { button, busy });
      if (found) await diagnosis(answer, found, (effect, place) => this.add(effect, place));
    });
    replace(this.parts.diagnosed, h("p", { class: "soft" }, "Which physical effect does the model lack, how sure is that, and what would adding it bring?"), h("div", { class: "row centre" }, button, search), answer, suggested);
    suggestions(suggested, this.path, () => this.model, (sentence) => this.extended(sentence));
    searchButton(search, this.path, () => this.model, (model_id, tell) => this.searched(model_id, tell));
  }

  async extended(sentence) {
    await this.open();
    replace(this.parts.change, h("div", { class: "good", role: "status" }, sentence));
    this.parts.change.scrollIntoView({ block: "center" });
  }

  async searched(model_id, tell) {
    await this.select(model_id);
    tell(this.parts.change);
    this.parts.change.scrollIntoView({ block: "center" });
  }

  add(effect, place) {
    const body = { effect, model_id: this.model };
    return attempt(place, async () => this.changed(await post(`${this.path}/models`, body)), { busy: "Fitting …" });
  }

  drop(effect) {
    const body = { effect, model_id: this.model, action: "drop" };
    return attempt(this.parts.change, async () => this.changed(await post(`${this.path}/models`, body)), { busy: "Fitting …" });
  }

  async changed(result) {
    const before = this.compared?.model_id === result.parent_id ? this.compared : await get(`${this.path}/compare`, { model_id: result.parent_id });
    replace(this.parts.change, h("div", { class: "good", role: "status" }, result.sentence));
    this.parts.change.scrollIntoView({ block: "start" });
    await this.select(result.model_id);
    if (this.compared?.model_id !== result.model_id) return;
    this.#plots.push(beforeAfter(this.parts.change, result, { before, after: this.compared, undo: () => this.undo(result.parent_id) }));
  }

  // back to the model before; the one that is left was made by the last change, and nothing was made from it
  undo(parent_id) {
    return attempt(this.parts.change, async () => {
      await remove(`${this.path}/models/${this.model}`);
      replace(this.parts.change);
      await this.select(parent_id);
    });
  }

  chips(rung) {
    const chip = (name) => h("span", { class: "chip" }, name.replaceAll("_", " "),
      h("button", { type: "button", title: `Drop ${name}`, "aria-label": `Drop ${name}`, onclick: () => this.drop(name) }, "×"));
    return h("div", { "aria-label": "Effects of this model" }, (rung?.effects ?? []).map(chip));
  }

  modelChoice(ladder) {
    const options = ladder.rungs.map((rung) => h("option", { value: String(rung.model_id), selected: rung.model_id === this.model }, rungName(rung)));
    const choice = h("select", { id: "model", onchange: (event) => this.select(Number(event.target.value)) }, options);
    const removable = ladder.rungs.length > 1 && !ladder.rungs.some((rung) => rung.parent_id === this.model) && ladder.rungs[0].model_id !== this.model;
    const take = () => this.undo(ladder.rungs.find((rung) => rung.model_id === this.model)?.parent_id ?? ladder.rungs[0].model_id);
    return h("div", { class: "row" }, h("label", { for: "model" }, "Shown model", choice),
      removable && h("button", { type: "button", onclick: take }, "Remove this model"));
  }
}

function heading(study, path) {
  const count = (role) => study.trials.filter((trial) => trial.role === role).length;
  return h("div", { class: "panel" }, h("h2", {}, `Study ${study.study_id}: ${study.name}`),
    h("p", { class: "soft" }, `${count("training")} training trials, ${count("held_out")} held out. Effort: ${study.effort.name} [${study.effort.unit}]. `,
      h("a", { href: "#study" }, "All studies")), withFiles([], [["Report", `Report of study ${study.study_id}`, `${path}/report`, `study-${study.study_id}.html`]]));
}
