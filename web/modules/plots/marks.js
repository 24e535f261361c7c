// Events of a trial as marks in a plot: when the joint broke away, settled, tripped or was stopped.

const ENDS = { tripped: "trip", failed: "failure", stopped: "stop", interrupted: "interruption" };
const MOVING = /^(ramp|raising|lowering)/;
const LOOK = {
  breakaway: { letter: "B", colour: "orange" }, settle: { letter: "S", colour: "green" }, "estimate": { letter: "E", colour: "blue" },
  trip: { letter: "T", colour: "red" }, failure: { letter: "F", colour: "red" }, stop: { letter: "■", colour: "red" },
  interruption: { letter: "!", colour: "red" },
};

// events in their order: [{time_s, name, detail}]; the joint breaks away where a ramp of the search ends
export function marksOf(events) {
  const marks = [];
  let phase = "";
  for (const { time_s: x, name, detail } of events) {
    const add = (kind, text) => marks.push({ x, kind, text, ...(LOOK[kind] ?? { letter: "", colour: "soft" }) });
    if (name === "search") {
      if (MOVING.test(phase) && detail !== "failed" && detail !== phase) add("breakaway", "breakaway");
      if (detail.startsWith("settle") && !detail.includes("before")) add("settle", "settle");
      if (detail === "done") add("estimate", "load found");
      if (detail === "failed") add("failure", "the search found no load");
      phase = detail;
    } else if (name === "end") {
      const kind = ENDS[detail.split(/[:;]/)[0]];
      if (kind) add(kind, detail);
    } else add(name, detail ? `${name}: ${detail}` : name);
  }
  return marks;
}

// one line of words for each kind of mark there is
export function markLegend(marks) {
  const kinds = [...new Map(marks.filter((mark) => mark.letter).map((mark) => [mark.kind, mark])).values()];
  return kinds.map((mark) => `${mark.letter} ${mark.kind}`).join(", ");
}
