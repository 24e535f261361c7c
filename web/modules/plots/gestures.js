// Moving about in a chart: drag, wheel with Ctrl, arrow keys, plus and minus. Esc is left alone: it is STOP.

const ZOOM = 0.7;
const STILL_PX = 4; // a press that moves less is no drag
const KEYS = {
  ArrowLeft: (chart) => chart.move(-0.2), ArrowRight: (chart) => chart.move(0.2),
  "+": (chart) => chart.zoom(ZOOM), "=": (chart) => chart.zoom(ZOOM), "-": (chart) => chart.zoom(1 / ZOOM),
  Home: (chart) => chart.showAll(), 0: (chart) => chart.showAll(),
};

export function gestures(canvas, chart) {
  let dragged = null;
  let pressed = null;
  canvas.addEventListener("keydown", (event) => {
    const act = event.ctrlKey || event.metaKey || event.altKey ? null : KEYS[event.key];
    if (!act) return;
    event.preventDefault();
    act(chart);
  });
  canvas.addEventListener("pointerdown", (event) => {
    dragged = event.offsetX;
    pressed = event.offsetX;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (dragged === null) {
      chart.point(event.offsetX);
      return;
    }
    chart.move((dragged - event.offsetX) / chart.plotWidth);
    dragged = event.offsetX;
  });
  canvas.addEventListener("pointerup", (event) => {
    if (Math.abs(event.offsetX - pressed) < STILL_PX) chart.choose(event.offsetX, event.offsetY);
  });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { dragged = null; });
  canvas.addEventListener("pointerleave", () => chart.point(null));
  canvas.addEventListener("dblclick", () => chart.showAll());
  // the wheel alone scrolls the page, as everywhere
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.shiftKey) return;
    event.preventDefault();
    chart.zoom(event.deltaY + event.deltaX > 0 ? 1 / ZOOM : ZOOM, event.offsetX);
  }, { passive: false });
}
