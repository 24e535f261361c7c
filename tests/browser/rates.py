"""What is asked of the page's speed and memory beside what is measured: `python -m tests.browser.rates --minutes N`."""

import argparse
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from tests.browser.browser import WITH_TOKEN, browser
from tests.service.running_service import RunningService, running_service
from tests.store.examples import begin, begin_trial

ROWS, RATE_HZ = 2_000_000, 200.0
OPENINGS = 5
SETTLE_S = 10  # before the heap is first measured: the browser compiles and caches

COUNT_FRAMES = """() => new Promise((done) => {
  const canvas = document.querySelector('canvas.chart');
  canvas.focus();
  let frames = 0;
  const begin = performance.now();
  const step = () => {
    canvas.dispatchEvent(new KeyboardEvent('keydown', { key: frames % 2 ? 'ArrowLeft' : 'ArrowRight', bubbles: true }));
    frames += 1;
    if (performance.now() - begin < 2000) requestAnimationFrame(step);
    else done(frames / ((performance.now() - begin) / 1000));
  };
  requestAnimationFrame(step);
})"""
BARE_FRAMES = """() => new Promise((done) => {
  let frames = 0;
  const begin = performance.now();
  const step = () => {
    frames += 1;
    if (performance.now() - begin < 2000) requestAnimationFrame(step);
    else done(frames / ((performance.now() - begin) / 1000));
  };
  requestAnimationFrame(step);
})"""
COUNT_DRAWINGS = """() => import('/static/modules/chart.js').then(({ Chart }) => {
  const show = Chart.prototype.show;
  window.shown = 0;
  Chart.prototype.show = function (content) {
    window.shown += 1;
    return show.call(this, content);
  };
})"""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=2.0, help="how long the live plot is watched")
    minutes = parser.parse_args().minutes
    heap = "--js-flags=--expose-gc"
    with tempfile.TemporaryDirectory() as at, running_service(Path(at)) as service, browser(heap) as chromium:
        page = chromium.new_page(viewport={"width": 1280, "height": 900})
        page.set_default_timeout(120_000)
        page.add_init_script(WITH_TOKEN)
        page.goto(service.url)
        _large_trial(page, service)
        _live(page, service, minutes)


def _large_trial(page: Any, service: RunningService) -> None:
    trial_id = _two_million_rows(service)
    page.evaluate("location.hash = '#trials'")
    plot = page.get_by_role("button", name=f"Plot trial {trial_id}")
    plot.wait_for()
    times = []
    for _ in range(OPENINGS):
        page.evaluate("document.querySelector('canvas.chart')?.closest('.panel').remove()")
        begin_s = time.monotonic()
        plot.click()
        page.locator("canvas.chart").wait_for()
        page.get_by_role("group", name="Channels of trial").locator(".legend-entry").first.wait_for()
        times.append(time.monotonic() - begin_s)
    print(f"a trial of {ROWS} rows opens (median of {OPENINGS}): {np.median(times):.2f} s; asked: less than 1 s")
    page.get_by_role("group", name="Channels of trial").get_by_role("button", name="Zoom in").click()
    page.wait_for_timeout(1500)
    moved, bare = page.evaluate(COUNT_FRAMES), page.evaluate(BARE_FRAMES)
    print(f"frames a second while it is moved: {moved:.0f}; of the empty page: {bare:.0f}; asked: the browser's rate")


def _two_million_rows(service: RunningService) -> int:
    store = service.store
    writer = begin_trial(store, begin(store))
    time_s = np.arange(ROWS) / RATE_HZ
    noise = np.random.default_rng(1).standard_normal(ROWS)
    writer.append(np.column_stack([time_s, np.sin(time_s / 50.0) + 0.01 * noise, 0.3 + 0.05 * noise]))
    writer.finish("completed", "", {})
    return writer.trial_id


def _live(page: Any, service: RunningService, minutes: float) -> None:
    page.evaluate("location.hash = '#bench'")
    page.locator(".badge.idle").wait_for()
    session = page.context.new_cdp_session(page)
    page.evaluate(COUNT_DRAWINGS)
    service.start("steps", pace="real-time", repeats=1000)
    page.wait_for_timeout(SETTLE_S * 1000)
    begin_s, first, shown = time.monotonic(), _heap_mb(session), page.evaluate("window.shown")
    print(f"heap after {SETTLE_S} s: {first:.2f} MB")
    while time.monotonic() - begin_s < 60.0 * minutes:
        page.wait_for_timeout(min(60_000, 30_000 * minutes))
        print(f"heap after {(time.monotonic() - begin_s) / 60.0:.1f} min: {_heap_mb(session):.2f} MB", flush=True)
    rate = (page.evaluate("window.shown") - shown) / (time.monotonic() - begin_s)
    print(f"updates of the live plot: {rate:.1f} a second; asked: 20")
    print(f"growth of the heap in {minutes:g} min: {_heap_mb(session) - first:+.2f} MB; asked: none")
    service.client.post("/stop")


def _heap_mb(session: Any) -> float:
    for _ in range(2):
        session.send("HeapProfiler.collectGarbage")
    return float(session.send("Runtime.getHeapUsage")["usedSize"]) / 2**20


if __name__ == "__main__":
    main()
