// A challenge: a joint that hides something. Make it, study its recordings, guess, and be told.

import { get, post } from "../app/api.js";
import { attempt, patiently } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { number, when } from "../ui/format.js";

const LEVELS = { easy: "easy: at most one, large", medium: "medium: up to two", hard: "hard: up to two, small, noisy recordings" };

// wanted: the challenge that is guessed at, if any. Resolves when the list is there
export function challengePanel(place, wanted = null) {
  const [list, answer, revealed] = [h("div"), h("div"), h("div", { class: "guess" })];
  place.className = "challenge";
  const level = h("select", { id: "difficulty" }, Object.entries(LEVELS).map(([value, text]) => h("option", { value }, text)));
  const button = h("button", { type: "button", class: "primary" }, "New challenge");
  const refresh = () => attempt(list, async () => {
    const { items } = await get("/challenges");
    replace(list, challengeTable(items, revealed));
    return items.find((one) => one.challenge_id === wanted);
  });
  button.addEventListener("click", async () => {
    const made = await patiently(answer, `challenge ${level.value}`, "Drawing a joint at random, and recording it …", (signal) => post("/challenges", { difficulty: level.value }, 0, { signal }), { button, again: () => button.click() });
    if (!made) return;
    replace(answer, h("div", { class: "good", role: "status" }, `Challenge ${made.challenge_id} is ready. Make a study of experiment ${made.experiment_id}, find what its model lacks, then come back and guess.`));
    await refresh();
  });
  replace(place, h("p", { class: "soft" }, "A joint is drawn at random; nothing, one or two mechanisms are hidden in it, and it is recorded. Find them from the recordings alone."),
    h("div", { class: "row" }, h("label", { for: "difficulty" }, "Difficulty", level), button), answer, list, revealed);
  return refresh().then((found) => found && guessForm(revealed, found));
}

function challengeTable(items, revealed) {
  if (!items.length) return h("p", { class: "soft" }, "No challenge yet.");
  return table("Challenges", [
    { title: "Challenge", cell: (one) => one.challenge_id },
    { title: "Difficulty", cell: (one) => one.difficulty },
    { title: "Made", cell: (one) => when(one.created_utc) },
    { title: "", cell: (one) => h("div", { class: "actions" },
      h("a", { class: "button small", href: `#study/new/${one.experiment_id}`, "aria-label": `Study challenge ${one.challenge_id}` }, "Study it"),
      h("button", { type: "button", class: "small reveal", "aria-label": `Guess at challenge ${one.challenge_id}`, onclick: () => guessForm(revealed, one) }, "Guess and reveal")) },
  ], items);
}

async function guessForm(place, challenge) {
  const effects = await attempt(place, async () => (await get("/effects")).items);
  if (!effects) return;
  const studies = await attempt(place, async () => (await get("/studies")).items);
  if (!studies) return;
  const own = await attempt(place, () => studyOf(challenge.experiment_id, studies));
  const options = [["nothing", "nothing is hidden"], ["none-of-these", "something, but no effect of the catalogue"], ...effects.map((one) => [one.name, one.title])];
  const choices = [0, 1].map((number_) => h("select", { id: `guess-${number_}` }, [["", number_ ? "– nothing more –" : "– choose –"], ...options].map(([value, text]) => h("option", { value }, text))));
  const study = h("select", { id: "guess-study" }, [h("option", { value: "" }, "– my own guess above –"), ...studies.map((one) => h("option", { value: String(one.study_id), selected: one.study_id === own }, `${one.study_id}: ${one.name}`))]);
  const answer = h("div");
  const submit = async (event) => {
    event.preventDefault();
    const guess = choices.map((choice) => choice.value).filter(Boolean).join(",");
    const body = study.value ? { study_id: Number(study.value) } : { guess };
    const told = await patiently(answer, "reveal", "Opening, and judging what the study says …", (signal, job) => post(`/challenges/${challenge.challenge_id}/reveal`, body, 0, { signal, job }), { button: event.submitter });
    if (!told) return;
    replace(answer, verdict(told));
    answer.scrollIntoView({ block: "nearest" });
  };
  replace(place, h("h3", {}, `What is hidden in challenge ${challenge.challenge_id}?`), h("form", { class: "form", onsubmit: submit },
    h("div", { class: "row" }, h("label", { for: "guess-0" }, "I say", choices[0]), h("label", { for: "guess-1" }, "and", choices[1]),
      h("label", { for: "guess-study" }, "or what a study added and found", study)), h("div", { class: "row" }, h("button", { class: "primary" }, "Reveal")), answer));
  place.scrollIntoView({ block: "nearest" });
  (own ? study : choices[0]).focus();
}

const LOOKED_AT = 5; // of the newest studies

// the newest study of a challenge's recordings, which is offered as the guess; undefined where there is none
async function studyOf(experiment_id, studies) {
  const [trial] = (await get("/trials", { experiment_id, limit: 1 })).items;
  const found = await Promise.all(studies.slice(0, LOOKED_AT).map(({ study_id }) => get(`/studies/${study_id}`).catch(() => null)));
  return found.find((study) => study?.trials.some((one) => one.trial_id === trial?.trial_id))?.study_id;
}

function verdict(told) {
  const line = (text, names) => names.length > 0 && h("p", {}, `${text}: ${names.join(", ").replaceAll("_", " ")}.`);
  return [h("div", { class: told.perfect ? "revealed good" : "revealed problem", role: "status" }, told.sentence), line("Right", told.right), line("Missed", told.missed),
    line("In every recording, whatever is hidden", told.recorded), line("Not there", told.wrong), line("Hidden, but no recording of motion can tell it from what every model has", told.untold),
    line("Hidden, but too little of it in these recordings to count as missed", told.faint),
    told.hidden.length > 0 && table("What was hidden", [
      { title: "Mechanism", cell: (one) => one.title },
      { title: "In the catalogue", cell: (one) => (one.effects.length ? one.effects.map((name) => h("a", { href: `#learn/${name}` }, `${name.replaceAll("_", " ")} `)) : "none of these") },
      { title: "Size", cell: (one) => `${number(one.size, 3)} ${one.unit === "1" ? "" : one.unit} (${one.measure})` },
      { title: "Share of the effort", number: true, cell: (one) => one.share_words },
    ], told.hidden), told.hidden.length > 0 && h("p", { class: "soft" }, "Share of the effort: rms of what the mechanism changes in the motor current of the motions, over the rms of that current; what two runs of one joint differ by anyway is taken off.")];
}
