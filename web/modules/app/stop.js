// STOP: the button, and Esc. Asks until the service answers, frees the way where other requests block it, and says whether
// the drive confirmed that its power is off.

import { freeTheWay, get, post } from "./api.js";

const TIMEOUT_MS = 1500;
const TRIES = 6;
const CONFIRMED_WITHIN_MS = 4000;
const ASK_EVERY_MS = 150;
const SHOWN_MS = 10_000;

const pause = (time_ms) => new Promise((resolve) => setTimeout(resolve, time_ms));

export function stopButton(button, answer) {
  let asked = 0;
  const say = (text, level) => {
    answer.textContent = text;
    answer.className = level;
  };
  const stop = async () => {
    asked += 1;
    const mine = asked; // a second press begins anew; what the first one finds is of no interest any more
    const tell = (text, level = "") => { if (mine === asked) say(text, level); };
    tell("Stopping …");
    const accepted = await ask(tell, () => mine === asked);
    if (!accepted) return;
    const [text, level] = await confirmation(accepted, tell);
    tell(text, level);
    if (level === "confirmed") setTimeout(() => tell(""), SHOWN_MS);
  };
  button.addEventListener("click", stop);
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    event.preventDefault();
    stop();
  });
}

async function ask(tell, wanted) {
  for (let tries = 1; tries <= TRIES && wanted(); tries += 1) {
    try {
      return await post("/stop", { reason: "STOP on the page" }, TIMEOUT_MS);
    } catch (error) {
      const why = error.name === "TimeoutError" ? `no answer within ${TIMEOUT_MS / 1000} s` : error.message;
      const again = tries < TRIES && error.status !== 401;
      tell(`Stop NOT confirmed: ${why}. Use the emergency stop of the bench.${again ? ` Asking again (${tries} of ${TRIES}) …` : ""}`, "unconfirmed");
      if (!again) return null;
      freeTheWay();
      await pause(ASK_EVERY_MS * tries);
    }
  }
  return null;
}

// what the drive made of it: the record of a run is closed only when the power is off, or could not be taken away
async function confirmation(accepted, tell) {
  if (!accepted.was_running) return [accepted.detail, "confirmed"];
  tell(`${accepted.detail} Waiting for the drive …`);
  const deadline = performance.now() + CONFIRMED_WITHIN_MS;
  while (performance.now() < deadline) {
    const run = await get("/bench", {}, { timeout_ms: TIMEOUT_MS }).then((bench) => bench.run, () => null);
    if (run && run.outcome !== "running") return verdict(run);
    await pause(ASK_EVERY_MS);
  }
  return [`Stop accepted, but NOT confirmed by the drive within ${CONFIRMED_WITHIN_MS / 1000} s. Use the emergency stop of the bench.`, "unconfirmed"];
}

export function verdict(run) {
  if (/power-off failed|quick stop failed/.test(run.reason)) {
    return [`Stop accepted, but NOT confirmed by the drive: ${run.reason}. Use the emergency stop of the bench.`, "unconfirmed"];
  }
  return [`Stop accepted and confirmed: the drive is powered off (experiment ${run.experiment_id} ${run.outcome}).`, "confirmed"];
}
