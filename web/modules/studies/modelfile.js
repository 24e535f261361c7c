// A model as a file: its effects, parameters with units and 95 % intervals, errors, and the trials that it was fitted to.

import { get } from "../app/api.js";
import { h } from "../ui/dom.js";
import { csv, save } from "../ui/save.js";

// study, compared: as the service answers
export function modelButtons(study, compared) {
  const name = `study-${study.study_id}-model-${compared.model_id}`;
  const button = (text, label, act) => h("button", { type: "button", class: "small", "aria-label": label, onclick: act }, text);
  const json = async () => {
    const { software_version: software } = await get("/bench");
    save(`${name}.json`, JSON.stringify(modelOf(study, compared, software), null, 2), "application/json");
  };
  const table = () => save(`${name}.csv`, parametersCsv(compared), "text/csv");
  return h("div", { class: "actions" }, button("Model (JSON)", `Save model ${compared.model_id} as JSON`, json), button("Parameters (CSV)", `Save the parameters of model ${compared.model_id} as CSV`, table));
}

export function modelOf({ study_id, name, trials }, { model_id, effects, effort, parameters, error, breakaway }, software) {
  return { software: `friction-bench ${software}`, study_id, study: name, model_id, effort, effects, parameters, error, breakaway,
    trials: trials.map(({ trial_id, name: called, role, conditions }) => ({ trial_id, name: called, role, conditions })) };
}

export function parametersCsv({ parameters }) {
  return csv([["effect", "parameter", "value", "unit", "low_95", "high_95", "note"], ...parameters.map((one) => [one.effect, one.name, one.value, one.unit, one.low, one.high, one.note])]);
}
