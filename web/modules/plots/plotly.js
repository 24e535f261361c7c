// Plots by plotly, with the colours of the page.

import { colour } from "../ui/colours.js";
import { h } from "../ui/dom.js";
import { csv, fileName, save } from "../ui/save.js";

// nothing of a bench leaves it: no button that sends a chart to somebody else's server
const CONFIG = { responsive: true, displaylogo: false, showSendToCloud: false, plotlyServerURL: "" };
const UNUSED = ["lasso2d", "select2d", "toImage"];
const MOVING = ["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "autoScale2d", "resetScale2d"]; // on a phone they would lie over the legend
const isNarrow = () => matchMedia("(max-width: 760px)").matches;

function config() {
  const nameOf = (plot) => fileName((plot.getAttribute("aria-label") ?? "").split(";")[0]);
  const picture = { name: "picture", title: "Save the picture (SVG)", icon: window.Plotly.Icons.camera, click: (plot) => window.Plotly.downloadImage(plot, { format: "svg", width: plot.clientWidth, height: plot.clientHeight, filename: nameOf(plot) }) };
  const numbers = { name: "numbers", title: "Save its numbers (CSV)", icon: window.Plotly.Icons.disk, click: (plot) => save(`${nameOf(plot)}.csv`, numbersOf(plot), "text/csv") };
  return { ...CONFIG, modeBarButtonsToRemove: isNarrow() ? [...UNUSED, ...MOVING] : UNUSED, modeBarButtonsToAdd: [picture, numbers] };
}

// a row for each point of each trace
function numbersOf({ data, layout: { xaxis, yaxis } }) {
  const rows = data.flatMap((trace) => Array.from(trace.x ?? [], (x, at) => [trace.name, x, trace.y[at]]));
  return csv([["line", xaxis?.title?.text ?? "x", yaxis?.title?.text ?? "y"], ...rows]);
}

function axis(extra) {
  return { gridcolor: colour("line"), zerolinecolor: colour("soft"), linecolor: colour("line"), automargin: true, exponentformat: "none", ...extra };
}

export function layout(extra = {}) {
  const base = {
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: colour("text"), family: "system-ui, sans-serif", size: isNarrow() ? 11 : 12 },
    margin: { l: 60, r: 12, t: 12, b: 44 }, legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 }, hovermode: "closest",
    uirevision: "keep", modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("soft"), activecolor: colour("accent") },
  };
  const axes = {};
  for (const [name, value] of Object.entries({ xaxis: {}, yaxis: {}, ...extra })) if (/^[xy]axis\d*$/.test(name)) axes[name] = axis(value);
  return { ...base, ...extra, ...axes };
}

export async function draw(place, traces, extra = {}) {
  place.classList.add("plot");
  const plotly = await library();
  return plotly.react(place, traces, layout(extra), config());
}

// STOP and the forms must not wait for a large file; and plotly must find its style sheet when it starts (see index.html)
async function load() {
  const sheet = document.getElementById("plotly.js-style-global");
  if (!sheet.sheet) await new Promise((resolve) => sheet.addEventListener("load", resolve));
  const script = h("script", { src: new URL("../../plotly.min.js", import.meta.url).href });
  await new Promise((resolve, reject) => {
    script.addEventListener("load", resolve);
    script.addEventListener("error", () => reject(new Error("the plots could not be loaded from the service; reload the page")));
    document.head.append(script);
  });
  return window.Plotly;
}

let loading = null;

// a megabyte, compressed: it is asked for with the first plot that needs it. One that failed is tried again
function library() {
  loading ??= load().catch((error) => {
    loading = null;
    throw error;
  });
  return loading;
}

export function forget(place) {
  if (place && window.Plotly) window.Plotly.purge(place);
}

// plots follow the page when it changes between light and dark
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  for (const place of document.querySelectorAll(".plot.js-plotly-plot")) window.Plotly.react(place, place.data, layout(place.layout), config());
});
