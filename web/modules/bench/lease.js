// Who has the bench: said where one starts something, taken and given back there. Whoever has it, everybody can stop.

import { get, post, remove, token } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace } from "../ui/dom.js";

const DURATION_S = 600;

export function leasePanel(place, live) {
  const [state, answer] = [h("span"), h("div")];
  let name = null;
  let shown = "";
  const know = async () => { name = token.get() ? ((await get("/token").catch(() => null))?.name ?? null) : null; };
  const act = (action) => async ({ currentTarget: button }) => {
    await know();
    await attempt(answer, action, { button });
  };
  const take = h("button", { type: "button", class: "small", onclick: act(() => post("/lease", { duration_s: DURATION_S })) }, "Take the bench");
  const release = h("button", { type: "button", class: "small", onclick: act(() => remove("/lease")) }, "Give it back");
  const show = () => {
    const lease = live.status?.lease;
    const key = JSON.stringify([lease?.token, lease?.holder, lease?.remaining_s === null, name]);
    if (key === shown) return;
    shown = key;
    const [text, mine] = leaseWords(lease, name);
    replace(state, text);
    state.className = lease && !mine ? "badge stale lease" : "soft";
    take.hidden = Boolean(lease);
    release.hidden = !mine || lease.remaining_s === null;
  };
  replace(place, h("div", { class: "row centre" }, state, take, release), answer);
  live.addEventListener("status", show);
  const known = () => know().then(show);
  document.addEventListener("token-set", known);
  known();
  return () => {
    live.removeEventListener("status", show);
    document.removeEventListener("token-set", known);
  };
}

// the words, and whether it is one's own
export function leaseWords(lease, name) {
  if (!lease) return ["The bench is free.", false];
  const until = lease.remaining_s === null ? " while the experiment runs" : "";
  if (lease.token === name) return [`You have the bench${until}.`, true];
  // a name that the holder gave is a person's; without one there is the token's alone
  const who = !lease.holder || lease.holder === lease.token ? `Token '${lease.token}'` : lease.holder;
  return [`${who} has the bench${until}: you can watch and stop, not start.`, false];
}
