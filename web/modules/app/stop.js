// STOP: the button, and Esc. Asks until the service answers, frees the way where other requests block it, and says whether
// the drive confirmed that its power is off. What is said here is taken back by state.js when it is no longer true.

import { freeTheWay, get, post } from "./api.js";

const TIMEOUT_MS = 1500;
const TRIES = 6;
const CONFIRMED_WITHIN_MS = 4000;
const ASK_EVERY_MS = 150;
const EMERGENCY = "Use the emergency stop of the bench.";

const pause = (time_ms) => new Promise((resolve) => setTimeout(resolve, time_ms));

export function stopButton(button, answer, state) {
  let asked = 0;
  const stop = async () => {
    asked += 1;
    const mine = asked; // a second press begins anew; what the first one finds is of no interest any more
    const run = state.live.status?.run;
    const pressed_id = run ? run.experiment_id ?? undefined : null; // undefined: it runs, and has no number yet
    const tell = (phase, text, experiment_id = pressed_id) => { if (mine === asked) state.stop = { phase, text, experiment_id }; };
    tell("asking", "Stopping …");
    const accepted = await ask(tell, () => mine === asked);
    if (accepted) tell(...(await confirmation(accepted, tell)));
  };
  button.addEventListener("click", stop);
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    event.preventDefault();
    stop();
  });
  // who pressed STOP before the page had a token wants it still
  document.addEventListener("token-set", () => { if (state.now.message?.phase === "no-token") stop(); });
  state.addEventListener("change", () => show(answer, state.now.message));
}

function show(answer, message) {
  const text = message?.text ?? "";
  if (answer.textContent !== text) answer.textContent = text;
  answer.className = message?.phase ?? "";
}

async function ask(tell, wanted) {
  for (let tries = 1; tries <= TRIES && wanted(); tries += 1) {
    try {
      return await post("/stop", { reason: "STOP on the page" }, TIMEOUT_MS);
    } catch (error) {
      if (error.status === 401) {
        const lacking = error.tokenMissing ? "this page has no token yet" : "the service refused the token of this page";
        tell("no-token", `Not stopped: ${lacking}. Paste the token and it stops at once. If it cannot wait: ${EMERGENCY.toLowerCase().replace(".", "")}, or press Ctrl-C where 'friction-bench serve' runs.`);
        return null;
      }
      const why = error.name === "TimeoutError" ? `no answer within ${TIMEOUT_MS / 1000} s` : error.message;
      const again = tries < TRIES;
      tell("unconfirmed", `Stop NOT confirmed: ${why}. ${EMERGENCY}${again ? ` Asking again (${tries} of ${TRIES}) …` : " Then press STOP again."}`);
      if (!again) return null;
      freeTheWay();
      await pause(ASK_EVERY_MS * tries);
    }
  }
  return null;
}

// what the drive made of it: the record of a run is closed only when the power is off, or could not be taken away
async function confirmation(accepted, tell) {
  if (!accepted.was_running) return ["confirmed", accepted.detail];
  tell("asking", `${accepted.detail} Waiting for the drive …`);
  const deadline = performance.now() + CONFIRMED_WITHIN_MS;
  while (performance.now() < deadline) {
    const run = await get("/bench", {}, { timeout_ms: TIMEOUT_MS }).then((bench) => bench.run, () => null);
    if (run && run.outcome !== "running") return verdict(run);
    await pause(ASK_EVERY_MS);
  }
  return ["unconfirmed", `Stop accepted, but NOT confirmed by the drive within ${CONFIRMED_WITHIN_MS / 1000} s. ${EMERGENCY}`];
}

export function verdict(run) {
  const { experiment_id, outcome, reason } = run;
  if (run.power_off === "failed") return ["unconfirmed", `Stop accepted, but NOT confirmed by the drive: ${reason}. ${EMERGENCY}`, experiment_id];
  return ["confirmed", `Stop accepted and confirmed: the drive is powered off (experiment ${experiment_id} ${outcome}).`, experiment_id];
}
