// The joint as one sees it from the side: arm and load at the measured angle, the motor side with its free play, the
// target, and the current as colour and arrow. Angle 0 hangs straight down; positive turns anticlockwise.

import { fixed } from "../ui/format.js";
import { withShownUnit } from "../ui/units.js";

const SVG = "http://www.w3.org/2000/svg";
const ARM = 92; // length in the drawing, whatever it is on the bench
const LEAST_PLAY = 0.02; // rad, so that free play can be seen at all: it is drawn larger than it is, and labelled
const REACH = 118;

export class JointDrawing {
  // label: what a screen reader is told besides the numbers
  constructor(place, { label = "The joint from the side" } = {}) {
    this.words = label;
    this.svg = node("svg", { viewBox: `${-REACH - 22} ${-REACH - 4} ${2 * REACH + 44} ${2 * REACH + 20}`, class: "joint", role: "img", "aria-label": label });
    this.range = node("path", { class: "joint-range" });
    this.target = node("line", { x1: 0, y1: 0, x2: 0, y2: ARM, class: "joint-target" });
    this.play = node("path", { class: "joint-play" });
    this.arm = node("g", { class: "joint-arm" });
    this.beam = node("line", { x1: 0, y1: 0, x2: 0, y2: ARM });
    this.load = node("circle", { cx: 0, cy: ARM, r: 6, class: "joint-load" });
    this.arm.append(this.beam, this.load);
    this.needle = node("line", { x1: 0, y1: 0, x2: 0, y2: 30, class: "joint-motor" });
    this.hub = node("circle", { r: 13, class: "joint-hub" });
    this.arrow = node("path", { class: "joint-current" });
    this.text = node("text", { y: REACH + 12, class: "joint-text", "text-anchor": "middle" });
    this.svg.append(this.range, node("line", { x1: 0, y1: ARM + 6, x2: 0, y2: ARM + 16, class: "joint-zero" }), this.play, this.target, this.arm, this.hub, this.needle, this.arrow, this.text);
    place.append(this.svg);
  }

  // rig: {position_min_rad, position_max_rad, current_a, play_rad, load_kg, heaviest_kg}; what is not known is left out
  rig(rig) {
    this.known = { ...this.known, ...rig };
    const { position_min_rad: low, position_max_rad: high, load_kg, heaviest_kg } = this.known;
    if (Number.isFinite(low) && Number.isFinite(high)) this.range.setAttribute("d", arc(REACH, low, high));
    this.load.setAttribute("r", loadRadius(load_kg, heaviest_kg));
    this.load.classList.toggle("unknown", !Number.isFinite(load_kg));
  }

  // position_rad: motor side, divided by the gear ratio; null where nothing is known
  show({ position_rad, target_rad, current_a, dimmed = false }) {
    const { svg, known = {} } = this;
    svg.classList.toggle("dimmed", dimmed || !Number.isFinite(position_rad));
    const at = Number.isFinite(position_rad) ? position_rad : 0;
    turn(this.arm, at);
    turn(this.needle, at);
    this.target.classList.toggle("hidden", !Number.isFinite(target_rad));
    if (Number.isFinite(target_rad)) turn(this.target, target_rad);
    const play = known.play_rad > 0 ? Math.max(known.play_rad, LEAST_PLAY) : 0;
    this.play.setAttribute("d", play ? wedge(ARM + 10, at - play / 2, at + play / 2) : "");
    const share = Number.isFinite(current_a) ? Math.max(-1, Math.min(1, current_a / (known.current_a || 1))) : 0;
    this.arrow.setAttribute("d", Math.abs(share) > 0.01 ? arrow(22, at, share) : "");
    this.hub.style.fill = `color-mix(in srgb, ${share < 0 ? "var(--sky)" : "var(--orange)"} ${Math.round(100 * Math.abs(share))}%, var(--panel))`;
    this.text.textContent = words({ position_rad, current_a });
    svg.setAttribute("aria-label", `${this.words}: ${this.text.textContent || "nothing measured yet"}`);
  }
}

export function words({ position_rad, current_a }) {
  const parts = [Number.isFinite(position_rad) && withShownUnit(position_rad, "rad", 3), Number.isFinite(current_a) && `${fixed(current_a, 2)} A`];
  return parts.filter(Boolean).join("  ");
}

// a heavier load is a larger disc: its area goes with its mass
export function loadRadius(load_kg, heaviest_kg) {
  if (!(load_kg > 0)) return 4;
  return 5 + 11 * Math.sqrt(Math.min(1, load_kg / (heaviest_kg || load_kg)));
}

function turn(element, angle_rad) {
  element.setAttribute("transform", `rotate(${(-angle_rad * 180) / Math.PI})`);
}

// where a point of that radius stands; the drawing's y points down
export function point(radius, angle_rad) {
  return [radius * Math.sin(angle_rad), radius * Math.cos(angle_rad)].map((value) => Number(value.toFixed(2)));
}

function arc(radius, from, to, sweep = 0) {
  return `M ${point(radius, from).join(" ")} A ${radius} ${radius} 0 ${Math.abs(to - from) > Math.PI ? 1 : 0} ${sweep} ${point(radius, to).join(" ")}`;
}

function wedge(radius, from, to) {
  return `${arc(radius, from, to)} L 0 0 Z`;
}

// round the hub, as long as the current is large, its head where it pushes
function arrow(radius, at, share) {
  const end = at + share * 2.2;
  const head = [-0.22, 0.22].map((side) => point(radius + 90 * Math.abs(side) * side, end - Math.sign(share) * 0.22));
  return `${arc(radius, at, end, share > 0 ? 0 : 1)} M ${head[0].join(" ")} L ${point(radius, end).join(" ")} L ${head[1].join(" ")}`;
}

function node(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}
