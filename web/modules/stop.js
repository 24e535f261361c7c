// STOP: the button, and Esc. Says whether the service confirmed it.

import { post } from "./api.js";

const TIMEOUT_MS = 3000;

export function stopButton(button, answer) {
  const stop = async () => {
    answer.textContent = "Stopping …";
    try {
      const result = await post("/stop", { reason: "STOP on the page" }, TIMEOUT_MS);
      answer.textContent = result.detail;
    } catch (error) {
      const why = error.name === "TimeoutError" ? `no answer within ${TIMEOUT_MS / 1000} s` : error.message;
      answer.textContent = `Stop NOT confirmed: ${why}. Use the emergency stop of the bench.`;
      return;
    }
    setTimeout(() => { answer.textContent = ""; }, 8000);
  };
  button.addEventListener("click", stop);
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    event.preventDefault();
    stop();
  });
}
