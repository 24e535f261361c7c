// A chart of lines over time, drawn at the browser's frame rate: rows with a common axis, zoom, pan, values at the pointer.

import { moved, whole, within, zoomed } from "./axis.js";
import { h, replace } from "../ui/dom.js";
import { csv, fileName, save } from "../ui/save.js";
import { number } from "../ui/format.js";
import { gestures } from "./gestures.js";
import { frame, nearest, paint, valueAt } from "./paint.js";
import { colour, faded } from "../ui/colours.js";
import { firstFrom } from "./thin.js";

const EMPTY = { rows: [{ title: "" }], lines: [], xTitle: "" };

export class Chart extends EventTarget {
  #content = EMPTY;
  #view = null; // null: all there is
  #pointer = null;
  #pending = false;
  #width = 0; // asked of the page when it changes: to ask in each frame makes the browser lay the page out each time
  #theme = null;

  // label: what a screen reader says of the picture; the numbers stand in the table or facts beside it
  // moves: whether there are buttons to move about; a small one has only those that save it
  constructor(place, { label, height = 420, moves = true }) {
    super();
    this.canvas = h("canvas", { class: "chart", tabindex: "0", role: "img", "aria-label": `${label}. Arrow keys move, plus and minus zoom, 0 shows all.` });
    this.canvas.style.height = `${height}px`;
    this.height = height;
    this.name = fileName(label);
    this.legend = h("div", { class: "legend" });
    this.values = h("div", { class: "values number" }, "\u00a0");
    const button = (text, name, act) => h("button", { type: "button", class: "small", title: name, "aria-label": name, onclick: act }, text);
    const moving = [button("−", "Zoom out", () => this.zoom(1 / 0.7)), button("+", "Zoom in", () => this.zoom(0.7)),
      button("◂", "Earlier", () => this.move(-0.5)), button("▸", "Later", () => this.move(0.5)), button("all", "Show all", () => this.showAll())];
    const tools = h("div", { class: "actions" }, moves ? moving : [],
      button("PNG", "Save the picture", () => this.savePicture()), button("CSV", "Save its numbers", () => this.saveNumbers()));
    this.element = h("div", { class: "chart-box" }, h("div", { class: "row centre between" }, this.legend, tools), this.canvas, this.values);
    place.append(this.element);
    gestures(this.canvas, this);
    this.observer = new ResizeObserver(() => {
      this.#width = this.canvas.clientWidth;
      this.height = this.canvas.clientHeight || height; // where its card has no room for all of it
      this.#theme = null;
      this.redraw();
    });
    this.observer.observe(this.canvas);
    this.scheme = matchMedia("(prefers-color-scheme: dark)");
    this.recolour = () => {
      this.#theme = null;
      this.redraw();
    };
    this.scheme.addEventListener("change", this.recolour);
  }

  get view() {
    return this.#view ?? this.limits;
  }

  get limits() {
    return this.#content.limits ?? whole(this.#content.lines);
  }

  get plotWidth() {
    const box = frame(0, 1, this.#width, this.height);
    return box.right - box.left;
  }

  // lines name their colour; see paint.js for the rest
  show(content) {
    this.#content = content;
    const key = content.lines.map((line) => `${line.name}|${line.colour}`).join("\n");
    if (this.legendKey !== key) replace(this.legend, content.lines.filter((line) => line.name).map(entry));
    this.legendKey = key;
    this.redraw();
  }

  showAll() {
    this.#setView(null);
  }

  look(from, to) {
    this.#setView(within([from, to], this.limits));
  }

  move(share) {
    this.#setView(moved(this.view, share, this.limits));
  }

  zoom(factor, pixel = null) {
    const [from, to] = this.view;
    const centre = pixel === null ? (from + to) / 2 : valueAt(pixel, this.view, frame(0, 1, this.#width, this.height));
    const next = zoomed(this.view, factor, centre, this.limits);
    const [low, high] = this.limits;
    this.#setView(next[0] <= low && next[1] >= high ? null : next);
  }

  point(pixel) {
    this.cursor = pixel === null ? null : valueAt(pixel, this.view, frame(0, 1, this.#width, this.height));
    this.dispatchEvent(new Event("cursor"));
  }

  // the point {line, index} that is nearest to where somebody pressed: heard as "choose"
  choose(x, y) {
    this.chosen = nearest({ x, y }, { width: this.#width, height: this.height, view: this.view, content: this.#content });
    if (this.chosen) this.dispatchEvent(new Event("choose"));
  }

  // where the values are read; null: nowhere
  get cursor() {
    return this.#pointer;
  }

  set cursor(x) {
    this.#pointer = x;
    this.redraw();
  }

  // what is in view, on the colour of the panel
  savePicture() {
    const copy = Object.assign(document.createElement("canvas"), { width: this.canvas.width, height: this.canvas.height });
    const context = copy.getContext("2d");
    context.fillStyle = colour("panel");
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(this.canvas, 0, 0);
    copy.toBlob((blob) => save(`${this.name}.png`, blob));
  }

  // of what is in view, a row for each point of each line
  saveNumbers() {
    const [from, to] = this.view;
    const rows = this.#content.lines.flatMap((line) => Array.from(line.x, (x, at) => [line.name, x, line.y[at]]).filter(([, x]) => x >= from && x <= to));
    save(`${this.name}.csv`, csv([["line", this.#content.xTitle, "value"], ...rows]), "text/csv");
  }

  redraw() {
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      this.#draw();
    });
  }

  close() {
    this.observer.disconnect();
    this.scheme.removeEventListener("change", this.recolour);
  }

  #setView(view) {
    this.#view = view;
    this.redraw();
    this.dispatchEvent(new Event("view"));
  }

  #draw() {
    const { canvas, height } = this;
    const width = this.#width;
    if (!width) return;
    const ratio = devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.#theme ??= theme();
    const content = { ...this.#content, lines: this.#content.lines.map((line) => ({ ...line, colour: this.#theme[line.colour] })),
      bands: this.#content.bands?.map((band) => ({ ...band, colour: this.#theme.faded[band.colour] })) };
    paint(context, { width, height, view: this.view, content, theme: this.#theme, pointer: this.#pointer, pixel: 1 / ratio });
    const values = this.#pointer === null ? "\u00a0" : this.#valuesAt(this.#pointer);
    if (this.values.textContent !== values) this.values.textContent = values;
  }

  #valuesAt(x) {
    const parts = this.#content.lines.filter((line) => line.name && line.x.length).map((line) => {
      const after = firstFrom(line.x, x);
      const index = after > 0 && (after === line.x.length || x - line.x[after - 1] < line.x[after] - x) ? after - 1 : after;
      return `${line.name} ${number(line.y[index], 4)}`;
    });
    return `${number(x, 5)}: ${parts.join(", ")}`;
  }
}

function entry(line) {
  const mark = h("span", { class: `swatch ${line.colour}${line.dash ? " dashed" : ""}`, "aria-hidden": "true" });
  return h("span", { class: "legend-entry" }, mark, line.name);
}

const COLOURS = ["text", "soft", "line", "blue", "orange", "green", "red", "purple", "sky"];

function theme() {
  const narrow = matchMedia("(max-width: 760px)").matches;
  return { ...Object.fromEntries(COLOURS.map((name) => [name, colour(name)])), shade: faded("orange", 0.25), font: `${narrow ? 11 : 12}px system-ui, sans-serif`,
    faded: Object.fromEntries(COLOURS.map((name) => [name, faded(name, 0.25)])) };
}
