// Equations of the catalogue, written in a small part of LaTeX, as MathML that the browser sets itself.

import { h } from "../ui/dom.js";

const SPACE = "http://www.w3.org/1998/Math/MathML";
const LETTERS = { alpha: "α", kappa: "κ", lambda: "λ", rho: "ρ", eta: "η", zeta: "ζ", pi: "π", beta: "β", gamma: "γ", delta: "δ", mu: "μ", omega: "ω", phi: "φ", sigma: "σ", tau: "τ", theta: "θ", Delta: "Δ" };
// signs that stand above by themselves: a full stop would lie within the letter
const ACCENTS = { tilde: "˜", dot: "˙", ddot: "¨", hat: "ˆ", bar: "¯" };
const SIGNS = { sum: "∑", cdot: "·", le: "≤", ge: "≥" };
const FUNCTIONS = new Set(["log", "max", "min", "sin", "cos", "tan", "exp", "tanh", "ln", "sgn"]);
const TOKEN = /\\(?:text|mathrm)\{[^}]*\}|\\[A-Za-z]+|\\.|[A-Za-z]|\d+(?:\.\d+)?|\S/g;

// shows the source itself where it holds something that is not known here
export function equation(source) {
  try {
    const tokens = source.match(TOKEN) ?? [];
    const content = row(tokens, null);
    if (tokens.length) throw new Error(`unexpected ${tokens[0]}`);
    const math = element("math", content);
    math.setAttribute("display", "block");
    math.setAttribute("aria-label", source);
    return reachable(h("div", { class: "equation" }, math));
  } catch {
    return h("code", { class: "equation" }, source);
  }
}

// one that is wider than its place is scrolled, also by the keyboard; the others are no stops of the Tab key
function reachable(place) {
  new ResizeObserver(() => {
    if (place.scrollWidth > place.clientWidth) {
      place.tabIndex = 0;
      place.setAttribute("role", "group");
      place.setAttribute("aria-label", "Equation, to be scrolled");
    } else for (const name of ["tabindex", "role", "aria-label"]) place.removeAttribute(name);
  }).observe(place);
  return place;
}

function element(name, ...children) {
  const made = document.createElementNS(SPACE, name);
  made.append(...children);
  return made;
}

function row(tokens, end) {
  const items = [];
  while (tokens.length && tokens[0] !== end) items.push(scripted(tokens));
  if (end !== null && tokens.shift() !== end) throw new Error(`missing ${end}`);
  return element("mrow", ...items);
}

// one item with its subscript and superscript
function scripted(tokens) {
  const base = item(tokens);
  let below = null;
  let above = null;
  while (tokens[0] === "_" || tokens[0] === "^") {
    if (tokens.shift() === "_") below = item(tokens);
    else above = item(tokens);
  }
  if (below && above) return element("msubsup", base, below, above);
  if (below) return element("msub", base, below);
  return above ? element("msup", base, above) : base;
}

function item(tokens) {
  const token = tokens.shift();
  if (token === undefined || token === "}") throw new Error("something is missing");
  if (token === "{") return row(tokens, "}");
  if (token.startsWith("\\")) return command(token.slice(1), tokens);
  if (/[A-Za-z]/.test(token)) return element("mi", token);
  if (/\d/.test(token)) return element("mn", token);
  const sign = element("mo", token === "-" ? "−" : token);
  if (token === "|") sign.setAttribute("stretchy", "false");
  return sign;
}

function command(name, tokens) {
  if (/^[,;: !]$/.test(name)) return space();
  if (name === "quad") return space("1em");
  if (name in LETTERS) return element("mi", LETTERS[name]);
  if (FUNCTIONS.has(name)) return element("mrow", element("mi", name), space());
  if (name in ACCENTS) return accented(ACCENTS[name], item(tokens));
  if (name.endsWith("}")) return upright(name.slice(name.indexOf("{") + 1, -1));
  if (name === "frac") return element("mfrac", item(tokens), item(tokens));
  if (name in SIGNS) return element("mo", SIGNS[name]);
  throw new Error(`unknown \\${name}`);
}

function space(width = "0.17em") {
  const made = element("mspace");
  made.setAttribute("width", width);
  return made;
}

function accented(sign, base) {
  const made = element("mover", base, element("mo", sign));
  return made;
}

function upright(text) {
  const made = element("mi", text);
  made.setAttribute("mathvariant", "normal");
  return made;
}
