// A strip of the days on which something was recorded: a bar for each, as high as there were trials; one shows that day.

import { get } from "../app/api.js";
import { h, replace } from "../ui/dom.js";

const SHOWN = 60; // days

// minutes that the local time is ahead of UTC
export function offsetMin() {
  return -new Date().getTimezoneOffset();
}

// choose(day): "" is all of them
export async function sessionStrip(place, chosen, choose) {
  const { items } = await get("/trials/days", { offset_min: offsetMin(), limit: SHOWN });
  const most = Math.max(...items.map((one) => one.trials), 1);
  const bar = (one) => {
    const words = `${one.day}: ${one.trials} ${one.trials === 1 ? "trial" : "trials"}${one.not_completed ? `, ${one.not_completed} not completed` : ""}`;
    const filled = h("span", { class: one.not_completed ? "fill orange" : "fill blue" });
    filled.style.height = `${heightOf(one.trials, most)}%`;
    const on = one.day === chosen();
    return h("button", { type: "button", class: "session", title: words, "aria-label": words, "aria-pressed": String(on), onclick: () => choose(on ? "" : one.day) }, filled);
  };
  const draw = () => replace(place, items.length > 1 && h("div", { class: "sessions", role: "group", "aria-label": "Days with trials, oldest first" }, [...items].reverse().map(bar)),
    items.length > 1 && h("p", { class: "soft" }, chosen() ? `Trials of ${chosen()}.` : `${items.length} days with trials, ${items.at(-1).day} to ${items[0].day}. Choose one to see its trials.`));
  draw();
  return draw;
}

// of the strip [%]: a day with one trial is seen beside one with ten thousand
export function heightOf(trials, most) {
  return trials ? 12 + (88 * Math.log1p(trials)) / Math.log1p(most) : 4;
}
