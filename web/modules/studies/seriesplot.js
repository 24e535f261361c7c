// Measured and predicted effort of a trial over time, the residual beneath; moments can be pointed at.

import { Chart } from "../plots/chart.js";
import { h, replace } from "../ui/dom.js";
import { milli } from "../ui/units.js";

const AROUND_S = 1.5;
const numbers = (values) => Float64Array.from(values, (value) => value ?? NaN);

export class SeriesPlot {
  #content = null;
  #shades = [];

  // series: of the model that is shown; earlier: of the model before, or nothing
  constructor(place, { series, earlier = [], effort, label = "Measured and predicted effort over time, residual beneath" }) {
    const alone = { series, earlier, names: { before: "before", now: "" } };
    Object.assign(this, { ...alone, alone, effort });
    this.choice = h("select", { id: `series-${label.length}` }, series.map((one) => h("option", { value: String(one.trial_id) }, one.name)));
    const picture = h("div");
    this.said = h("div", { role: "status" });
    replace(place, h("label", { class: "inline" }, "Trial", this.choice), this.said, picture);
    this.chart = new Chart(picture, { label, height: 400 });
    this.choice.addEventListener("change", () => this.show(Number(this.choice.value)));
    if (series.length) this.show(series[0].trial_id);
  }

  // the model before beside the one after it; the trial that gained most is shown first, held-out ones before others
  compareWith(before, after) {
    this.earlier = before.series;
    this.show(gained(before, after)[0].trial_id);
  }

  // another model beside this one; names: {before, now}
  between(other, names) {
    Object.assign(this, { earlier: other.series, names });
    this.show(this.series[0].trial_id);
  }

  // what a missing effect would take away; found: as GET /studies/{id}/action answers
  withEffect({ title, series }) {
    Object.assign(this, { series, earlier: this.alone.series, names: { before: "by the model", now: "with the effect" } });
    const back = h("button", { type: "button", class: "small", onclick: () => this.modelAlone() }, "The model alone");
    replace(this.said, h("div", { class: "row centre" }, h("span", {}, `With ${title}: between the two lines lies what it would take away.`), back));
    this.show(this.trial_id);
  }

  modelAlone() {
    Object.assign(this, this.alone);
    replace(this.said);
    this.show(this.trial_id);
  }

  // the trial that is shown
  get trial_id() {
    return Number(this.choice.value);
  }

  show(trial_id, shades = []) {
    const one = this.series.find((each) => each.trial_id === trial_id);
    if (!one) return;
    this.choice.value = String(trial_id);
    const before = this.earlier.find((each) => each.trial_id === trial_id);
    const unit = this.effort.unit;
    const called = (what, which) => (which ? `${what} ${which}` : what);
    const { before: then, now } = this.names;
    const small = milli(Math.max(...(before ?? one).residual.map(Math.abs), ...one.residual.map(Math.abs)), unit);
    const line = (source, key, extra) => ({ x: numbers(source.time_s), y: numbers(source[key]).map((value) => (extra.row ? small.factor : 1) * value), ...extra });
    const lines = [
      line(one, "measured", { row: 0, name: "measured", colour: "blue" }),
      before && line(before, "predicted", { row: 0, name: called("predicted", then), colour: "purple", dash: [2, 3] }),
      line(one, "predicted", { row: 0, name: called("predicted", now), colour: "orange", dash: [6, 4], width: 2 }),
      before && line(before, "residual", { row: 1, name: called("residual", then), colour: "purple", dash: [2, 3] }),
      line(one, "residual", { row: 1, name: called("residual", now), colour: "red" }),
    ].filter(Boolean);
    this.#content = { rows: [{ title: `effort [${unit}]` }, { title: `residual [${small.unit}]` }], lines, xTitle: "time in the trial [s]" };
    this.#shades = shades;
    this.brush([]);
    this.chart.showAll();
  }

  // shades more of the trial, as long as something else is pointed at
  brush(shades) {
    if (this.#content) this.chart.show({ ...this.#content, shades: [...this.#shades, ...shades] });
  }

  // focus: whether the keyboard follows
  showMoment({ trial_id, from_s, to_s }, { focus = true } = {}) {
    this.show(trial_id, [{ from: from_s, to: to_s }]);
    this.chart.look(from_s - AROUND_S, to_s + AROUND_S);
    this.chart.element.scrollIntoView({ block: "nearest" });
    if (focus) this.chart.canvas.focus({ preventScroll: true });
  }

  close() {
    this.chart.close();
  }
}

function gained(before, after) {
  const error = (compared, trial_id) => compared.trials.find((one) => one.trial_id === trial_id)?.rms ?? 0;
  const held = new Set(after.trials.filter((one) => one.role === "held_out").map((one) => one.trial_id));
  const gain = (one) => error(before, one.trial_id) - error(after, one.trial_id) + (held.has(one.trial_id) ? 1e6 : 0);
  return [...after.series].sort((one, other) => gain(other) - gain(one));
}
