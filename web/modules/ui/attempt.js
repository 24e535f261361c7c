// Errors shown where they arose, in the words of the service; what takes long says how far it has come.
// A view shows itself when its first answers are there, all at once: nothing jumps while it fills.

import { events } from "../app/api.js";
import { h } from "./dom.js";
import { capital } from "./format.js";

export function problemBox(error) {
  const words = error.tokenMissing ? "This needs the token: paste it at the head of the page." : capital(error.message);
  return h("div", { class: "problem", role: "alert" }, words);
}

// what moves nothing goes on by itself once there is a token; what moves something has to be pressed again
function onceThereIsAToken(error, again) {
  if (error.status === 401 && again) document.addEventListener("token-set", again, { once: true });
}

// runs an action; `place` says meanwhile that it is busy, and afterwards what went wrong
export async function attempt(place, action, { button = null, busy = "", again = null } = {}) {
  if (busy) place.replaceChildren(h("p", { class: "busy", role: "status" }, busy));
  else place.querySelector(":scope > .problem")?.remove();
  if (button) button.disabled = true;
  try {
    const result = await action();
    if (busy) place.querySelector(":scope > .busy")?.remove();
    return result;
  } catch (error) {
    if (error.name !== "AbortError") place.replaceChildren(problemBox(error));
    onceThereIsAToken(error, again);
    return undefined;
  } finally {
    if (button) button.disabled = false;
  }
}

// how long it usually takes [s], until this browser has seen it once
const USUAL_S = { "challenge easy": 12, "challenge medium": 12, "challenge hard": 12, "new study": 4, fit: 4, compare: 4, diagnose: 10, search: 30, suggest: 15, round: 30, "closed-loop": 10, report: 15, reveal: 3, example: 2 };

// runs what takes a while: `place` says what is done now, for how long it has run and about how long it still takes, and
// cancels it. action(signal, job): the request; the service ends what it computes when the request is broken off. One that
// goes under the name `job` is followed: the service tells how far it has come; of others it is known what they took last
export async function patiently(place, key, words, action, { button = null, again = null } = {}) {
  const way = new AbortController();
  const expected_s = Number(localStorage.getItem(`took ${key}`)) || USUAL_S[key] || null;
  const begin_ms = performance.now();
  const [bar, told] = [h("progress", { "aria-label": words, ...(expected_s ? { max: expected_s } : {}) }), h("span", { class: "soft" })];
  let record = null;
  const show = () => {
    const passed_s = (performance.now() - begin_ms) / 1000;
    if (record?.stages) Object.assign(bar, { max: 1, value: record.share });
    else if (expected_s) bar.value = Math.min(passed_s, 0.97 * expected_s);
    const left_s = record?.left_s ?? (expected_s ? expected_s - passed_s : null);
    const left = left_s === null ? "" : left_s > 0 ? `, about ${Math.ceil(left_s)} s left` : ", longer than usual";
    told.textContent = `${stageOf(record)}${Math.round(passed_s)} s${left}`;
  };
  place.replaceChildren(h("div", { class: "waiting" }, h("p", { class: "busy", role: "status" }, words), bar, told,
    h("button", { type: "button", class: "small", onclick: () => way.abort() }, "Cancel")));
  show();
  const timer = setInterval(show, 1000);
  const job = `${Date.now().toString(36)}-${Math.random().toString(36).slice(2)}`;
  if (action.length > 1) follow(job, way.signal, (found) => {
    record = found;
    show();
  });
  if (button) button.disabled = true;
  try {
    const result = await action(way.signal, job);
    localStorage.setItem(`took ${key}`, String((performance.now() - begin_ms) / 1000));
    place.replaceChildren();
    return result;
  } catch (error) {
    place.replaceChildren(error.name === "AbortError" ? h("p", { class: "soft", role: "status" }, "Cancelled: nothing of it is kept.") : problemBox(error));
    onceThereIsAToken(error, again);
    return undefined;
  } finally {
    clearInterval(timer);
    if (button) button.disabled = false;
  }
}

function stageOf(record) {
  if (!record?.stages) return record?.state === "waiting" ? "Waiting for another computation, " : "";
  return record.stage ? `${record.stage}, ${record.stages_done + 1} of ${record.stages}. ` : "";
}

// one that cannot be followed goes on all the same
async function follow(job, signal, told) {
  try {
    for await (const { data } of events(`/live/jobs/${job}/stream`, signal)) told(data);
  } catch {
    // the request itself tells what is wrong
  }
}

const LONGEST_MS = 5000; // then what there is is shown; STOP, in the head of the page, waits for nothing

export function together(place, firstAnswers) {
  const timer = setTimeout(() => show(), LONGEST_MS);
  const show = () => {
    clearTimeout(timer);
    place.classList.remove("filling");
    place.removeAttribute("aria-busy");
  };
  place.classList.add("filling");
  place.setAttribute("aria-busy", "true");
  Promise.allSettled(firstAnswers).then((settled) => {
    show();
    for (const { reason } of settled) if (reason) reportError(reason); // a fault of the page itself: not to be swallowed
  });
}
