"""What is asked of the page's speed and memory beside what is measured: `python -m tests.browser.rates --minutes N`.

The service is `friction-bench serve`, in processes of its own. A browser without a graphics card on few cores is slow
by itself: what it makes of an empty canvas of the same size, in turn with what is measured, stands beside it.
"""

import argparse
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import numpy as np
from scipy import stats

from bench.store import Store
from tests.browser.browser import WITH_TOKEN, browser
from tests.service.running_service import TOKEN
from tests.service.served_process import served_process
from tests.store.examples import begin, begin_trial

ROWS, RATE_HZ = 2_000_000, 200.0
OPENINGS = 5
ROUNDS = 5
SETTLE_S = 10  # before the heap is first measured: the browser compiles and caches
HEAP_EVERY_S = 10.0

# frames a second while something is done in each; `act` gets the number of the frame
FRAMES = """(act) => new Promise((done) => {
  let frames = 0;
  const begin = performance.now();
  const step = () => {
    act(frames);
    frames += 1;
    const passed_ms = performance.now() - begin;
    if (passed_ms < 1000) requestAnimationFrame(step);
    else done(frames / (passed_ms / 1000));
  };
  requestAnimationFrame(step);
})"""
# ten frames there, ten frames back: out of what was read closer, and into it again
MOVED = f"""() => {{
  const canvas = document.querySelector('canvas.chart');
  canvas.focus();
  const press = (key) => canvas.dispatchEvent(new KeyboardEvent('keydown', {{ key, bubbles: true }}));
  return ({FRAMES})((frame) => press(frame % 20 < 10 ? 'ArrowRight' : 'ArrowLeft'));
}}"""
EMPTY = f"""() => {{
  const chart = document.querySelector('canvas.chart');
  const canvas = document.createElement('canvas');
  Object.assign(canvas, {{ width: chart.width, height: chart.height }});
  canvas.style.cssText = 'position: fixed; top: 0; left: 0;';
  document.body.append(canvas);
  const context = canvas.getContext('2d');
  const frames = ({FRAMES})((frame) => {{
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.fillRect(frame % canvas.width, 0, 10, 10);
  }});
  return frames.finally(() => canvas.remove());
}}"""
# the chart clears its canvas once for each picture that it draws
COUNT_PICTURES = """() => {
  window.pictures = 0;
  const clear = CanvasRenderingContext2D.prototype.clearRect;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    if (this.canvas.classList.contains('chart')) window.pictures += 1;
    return clear.apply(this, box);
  };
}"""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=2.0, help="how long the live plot is watched")
    minutes = parser.parse_args().minutes
    with tempfile.TemporaryDirectory() as at:
        trial_id = _two_million_rows(Path(at))
        with served_process(Path(at)) as url, browser("--js-flags=--expose-gc") as chromium:
            page = chromium.new_page(viewport={"width": 1280, "height": 900})
            page.set_default_timeout(120_000)
            page.add_init_script(WITH_TOKEN)
            page.goto(url)
            _large_trial(page, trial_id)
            _live(page, url, minutes)


def _two_million_rows(folder: Path) -> int:
    time_s = np.arange(ROWS) / RATE_HZ
    noise = np.random.default_rng(1).standard_normal(ROWS)
    with Store.open(f"sqlite:///{folder / 'bench.sqlite'}") as store:
        writer = begin_trial(store, begin(store))
        writer.append(np.column_stack([time_s, np.sin(time_s / 50.0) + 0.01 * noise, 0.3 + 0.05 * noise]))
        writer.finish("completed", "", {})
        return writer.trial_id


def _large_trial(page: Any, trial_id: int) -> None:
    page.evaluate("location.hash = '#trials'")
    plot = page.get_by_role("button", name=f"Plot trial {trial_id}")
    plot.wait_for()
    group = page.get_by_role("group", name="Channels of trial")
    times = []
    for _ in range(OPENINGS):
        page.evaluate("document.querySelector('canvas.chart')?.closest('.panel').remove()")
        begin_s = time.monotonic()
        plot.click()
        page.locator("canvas.chart").wait_for()
        group.locator(".legend-entry").first.wait_for()
        times.append(time.monotonic() - begin_s)
    print(f"a trial of {ROWS} rows opens (median of {OPENINGS}): {np.median(times):.2f} s; asked: less than 1 s")
    for share in (1.0, 0.05):
        while share < 1.0 and page.evaluate("window.share ?? 1") > share:
            group.get_by_role("button", name="Zoom in").click()
            page.evaluate("window.share = (window.share ?? 1) * 0.7")
        page.wait_for_timeout(1500)  # what is read closer has come
        moved, empty = (np.median(found) for found in zip(*_rounds(page), strict=True))
        print(
            f"frames a second while {100 * share:g} % of it is moved: {moved:.0f}; of an empty canvas in turn with it: "
            f"{empty:.0f}; ratio {moved / empty:.2f} (medians of {ROUNDS}); asked: the browser's rate"
        )


def _rounds(page: Any) -> Iterator[tuple[float, float]]:
    for _ in range(ROUNDS):
        yield page.evaluate(MOVED), page.evaluate(EMPTY)


def _live(page: Any, url: str, minutes: float) -> None:
    page.evaluate("location.hash = '#bench'")
    page.locator(".badge.idle").wait_for()
    session = page.context.new_cdp_session(page)
    page.evaluate(COUNT_PICTURES)
    with httpx.Client(base_url=f"{url}/api/v1", headers={"Authorization": f"Bearer {TOKEN}"}) as client:
        body = {"kind": "steps", "pace": "real-time", "parameters": {"repeats": 1000}}
        client.post("/experiments", json=body).raise_for_status()
        page.wait_for_timeout(SETTLE_S * 1000)
        begin_s, shown = time.monotonic(), page.evaluate("window.pictures")
        heap = []
        while not heap or time.monotonic() - begin_s < 60.0 * minutes:
            heap.append((time.monotonic() - begin_s, _heap_mb(session)))
            page.wait_for_timeout(min(1000.0 * HEAP_EVERY_S, 15_000.0 * minutes))
        rate = (page.evaluate("window.pictures") - shown) / (time.monotonic() - begin_s)
        client.post("/stop").raise_for_status()
    print(f"pictures of the live plot: {rate:.1f} a second; asked: 20")
    at_s, heap_mb = np.array(heap).T
    print(
        f"heap: {heap_mb[0]:.2f} MB after {SETTLE_S} s, {heap_mb[-1]:.2f} MB after {minutes:g} min more; "
        f"{_slope(at_s, heap_mb)}"
    )


def _slope(at_s: np.ndarray, heap_mb: np.ndarray) -> str:
    if len(at_s) < 3:
        return "watch longer for its slope"
    fit = stats.linregress(at_s / 3600.0, heap_mb)
    half = stats.t.ppf(0.975, len(at_s) - 2) * fit.stderr
    return f"slope {fit.slope:+.2f} MB/h (95 %: {fit.slope - half:+.2f} .. {fit.slope + half:+.2f}); asked: no growth"


def _heap_mb(session: Any) -> float:
    for _ in range(2):
        session.send("HeapProfiler.collectGarbage")
    return float(session.send("Runtime.getHeapUsage")["usedSize"]) / 2**20


if __name__ == "__main__":
    main()
