// The colours of the page, as style.css names them: Okabe-Ito, told apart with any colour vision.

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export const SERIES = ["blue", "red", "green", "orange", "purple", "sky"];

export function faded(name, alpha = 0.2) {
  const hex = colour(name).slice(1);
  const [r, g, b] = [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16));
  return `rgba(${r},${g},${b},${alpha})`;
}
