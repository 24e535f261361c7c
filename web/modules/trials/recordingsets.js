// Recordings of other benches come in: a recording set as a zip, or files as they are, whose columns are shown first.

import { upload } from "../app/api.js";
import { attempt } from "../ui/attempt.js";
import { h, replace, table } from "../ui/dom.js";
import { capital, nameOf } from "../ui/format.js";
import { zipOf } from "./zip.js";

const OWN = ["rig.toml", "mapping.toml"];

// done(made): it is in the store; open: whether its fields are shown at once
export function importForm(done, open = false) {
  const file = h("input", { type: "file", multiple: true, id: "import-file", required: true });
  const name = h("input", { id: "import-name" });
  const answer = h("div");
  const button = h("button", {}, "Import");
  const finish = (result) => {
    replace(answer, h("div", { class: "good", role: "status" }, `Imported ${result.trials} trials as experiment ${result.experiment_id}.`),
      result.notes.map((note) => h("p", { class: "hint" }, capital(note))));
    done(result);
  };
  const submit = async (event) => {
    event.preventDefault();
    const chosen = [...file.files];
    const called = name.value || chosen[0].name.replace(/\.[^.]*$/, "");
    if (isSet(chosen)) {
      const result = await attempt(answer, async () => upload("/recording-sets", await asZip(chosen), { name: called }), { button });
      if (result) finish(result);
    } else {
      await show(answer, chosen, called, button, finish);
    }
  };
  return h("details", { open, ondragover: (event) => event.preventDefault(), ondrop: (event) => dropped(event, file) },
    h("summary", {}, "Import a recording set, or files of any bench"), h("form", { class: "row", onsubmit: submit },
      h("label", { for: "import-file" }, "Recording set (.zip), or files: each a trial", file),
      h("label", { for: "import-name" }, "Name (optional)", name), button), answer);
}

function dropped(event, file) {
  event.preventDefault();
  file.files = event.dataTransfer.files;
}

// a set says itself what its columns are
function isSet(files) {
  return (files.length === 1 && files[0].name.toLowerCase().endsWith(".zip")) || files.some((one) => OWN.includes(one.name));
}

async function asZip(files, further = []) {
  if (files.length === 1 && files[0].name.toLowerCase().endsWith(".zip")) return files[0];
  const read = await Promise.all(files.map(async (one) => [one.name, new Uint8Array(await one.arrayBuffer())]));
  return zipOf([...read, ...further.map(([name, text]) => [name, new TextEncoder().encode(text)])]);
}

// what each column is taken for, and what is asked; it comes in once nothing is left to be asked and a person confirms
async function show(answer, files, name, button, finish) {
  const said = { take: [], counts_per_turn: "", rate_hz: "", supply_v: "" };
  const ask = async () => {
    const pairs = [["name", name], ...said.take.map((one) => ["take", one]), ...Object.entries(said).filter(([key, value]) => key !== "take" && value)];
    const found = await attempt(answer, async () => upload("/recording-sets/guess", await asZip(files), pairs), { button });
    if (found) replace(answer, columns(found, said, ask), found.questions.length ? questions(found, said, ask) : confirm(found, files, name, answer, finish));
  };
  await ask();
}

// said.take has what a person chose for a column; ask(): guess anew with it
function columns(found, said, ask) {
  const chosen = (column) => said.take.find((one) => one.startsWith(`${column}=`))?.slice(column.length + 1);
  const choose = (column, wanted) => {
    said.take = said.take.filter((one) => !one.startsWith(`${column}=`));
    if (wanted) said.take.push(`${column}=${wanted}`);
    ask();
  };
  const offered = Object.entries(found.quantities).flatMap(([quantity, units]) => units.map((unit) => `${quantity}[${unit}]`));
  const choice = ({ column, channel }) => {
    const now = chosen(column);
    const select = h("select", { "aria-label": `What ${column} is`, onchange: () => choose(column, select.value) },
      h("option", { value: "" }, now ? "as it was guessed" : channel || "not used"), ["ignore", ...offered].map((one) => h("option", { value: one, selected: one === now }, wordsOf(one))));
    return select;
  };
  return h("div", {}, found.notes.map((note) => h("p", { class: "hint" }, asked(note))), table("Columns", [
    { title: "Column", cell: (one) => one.column },
    { title: "Taken for", cell: choice },
    { title: "In", cell: (one) => one.unit },
    { title: "From", number: true, cell: (one) => one.low?.toPrecision(4) },
    { title: "To", number: true, cell: (one) => one.high?.toPrecision(4) },
    { title: "Over time", cell: (one) => picture(one.outline) },
    { title: "Because", cell: (one) => one.why },
  ], found.columns));
}

// "position[deg]" -> "position [deg]"
function wordsOf(quantity) {
  return quantity === "ignore" ? "not used" : nameOf(quantity).replace("[1]", "").replace("[", " [");
}

// the options of the command line, as one does the same here
export function asked(question) {
  return question.replace(/say --take|--take/g, "choose").replace(/'([^'=]+)=(\w+)\[([^\]]+)\]'/g, "$2 [$3] for '$1'").replace(/'([^'=]+)=ignore'/g, "not used for '$1'").replace(/--([a-z]+(?:-[a-z]+)*)/g, (_, name) => name.replaceAll("-", " "));
}

function picture(values) {
  if (values.length < 2) return "";
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const points = values.map((value, at) => `${(120 * at) / (values.length - 1)},${22 - (20 * (value - low)) / (high - low || 1)}`).join(" ");
  const space = "http://www.w3.org/2000/svg";
  const [drawn, line] = [document.createElementNS(space, "svg"), document.createElementNS(space, "polyline")];
  for (const [key, value] of Object.entries({ width: 120, height: 24, "aria-hidden": "true" })) drawn.setAttribute(key, value);
  for (const [key, value] of Object.entries({ points, fill: "none", stroke: "currentColor" })) line.setAttribute(key, value);
  drawn.append(line);
  return drawn;
}

function questions(found, said, ask) {
  const fields = {
    counts_per_turn: h("input", { id: "guess-counts", type: "number", min: "0", step: "any", value: said.counts_per_turn }),
    rate_hz: h("input", { id: "guess-rate", type: "number", min: "0", step: "any", value: said.rate_hz }),
    supply_v: h("input", { id: "guess-supply", type: "number", step: "any", value: said.supply_v }),
  };
  const submit = (event) => {
    event.preventDefault();
    for (const [key, field] of Object.entries(fields)) said[key] = field.value.trim();
    ask();
  };
  return h("form", { onsubmit: submit }, h("div", { class: "problem", role: "alert" }, found.questions.map((one) => h("p", {}, capital(asked(one)))), h("p", {}, "Choose in the table above, or fill in:")),
    h("label", { for: "guess-counts" }, "Counts per turn of the joint", fields.counts_per_turn),
    h("label", { for: "guess-rate" }, "Samples a second [Hz]", fields.rate_hz),
    h("label", { for: "guess-supply" }, "Supply [V]", fields.supply_v), h("button", {}, "Answer"));
}

function confirm(found, files, name, answer, finish) {
  const place = h("div");
  const button = h("button", { type: "button", onclick: async () => {
    const further = [["mapping.toml", found.mapping], ["rig.toml", found.rig]];
    const result = await attempt(place, async () => upload("/recording-sets", await asZip(files, further), { name }), { button });
    if (result) finish(result);
  } }, "These columns are right: import");
  return h("div", {}, button, place);
}
