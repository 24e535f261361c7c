"""What is asked of the page beside what is measured: `python -m tests.browser.figures`.

The service is `friction-bench serve` with 100 000 trials in its store, in processes of its own; the control loop of the
simulated joint runs at 1 kHz.
"""

import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import httpx

from bench.store import Store
from tests.browser.browser import WITH_TOKEN, browser
from tests.browser.rates import COUNT_PICTURES
from tests.service.recorded_joint import recording_set_zip
from tests.service.running_service import TOKEN
from tests.service.served_process import served_process
from tests.store.rates import fill

TRIALS = 100_000
HEIGHT = 900
VIEWS = ("#home", "#bench", "#numbers", "#commission", "#queue", "#trials", "#study", "#study/1/compare", "#learn")
STEPS = ("record", "compare", "diagnose", "add", "result")
SCHEMES = ((1440, "light"), (1440, "dark"), (390, "light"), (390, "dark"))
PAGES: dict[str, dict[str, Any]] = {
    "newest": {}, "by name": {"sort": "name"}, "two words": {"words": "steps nlgi"}, "last": {"offset": TRIALS - 50},
}  # fmt: skip
REPEATS = 5
LIVE_S = 10.0
CONTROLS = "a, button, input, select, textarea, summary, [tabindex='0']"
FIRST_SCREEN = f"""() => {{
  const shown = [...document.querySelectorAll("{CONTROLS}")].filter((one) => one.checkVisibility());
  const entries = performance.getEntries();
  return {{
    controls: shown.length, words: document.body.innerText.trim().split(/\\s+/).length,
    painted_ms: performance.getEntriesByName("first-contentful-paint")[0].startTime
      - performance.getEntriesByType("navigation")[0].responseEnd,
    sent: entries.reduce((sum, one) => sum + (one.transferSize ?? 0), 0),
  }};
}}"""
NODES = "document.querySelectorAll('*').length"
COUNT_FRAMES = """() => {
  window.frames_seen = 0;
  const step = () => { window.frames_seen += 1; requestAnimationFrame(step); };
  requestAnimationFrame(step);
}"""


@dataclass(frozen=True)
class Figure:
    """One line of the table."""

    what: str
    asked: str
    measured: str
    met: bool


def main() -> None:
    """Measure everything, and print it."""
    lines = list(figures())
    width = max(len(one.what) for one in lines)
    print(f"{'what':{width}} | {'asked':>12} | measured")
    for one in lines:
        print(f"{one.what:{width}} | {one.asked:>12} | {one.measured}{'' if one.met else '   NOT MET'}")


def figures() -> Iterator[Figure]:
    """All of them."""
    with tempfile.TemporaryDirectory() as at:
        folder = Path(at)
        with Store.open(f"sqlite:///{folder / 'bench.sqlite'}") as store:
            fill(store, TRIALS)
        paper = (resources.files("bench.config") / "presets" / "paper.toml").read_text(encoding="utf-8")
        (folder / "bench.toml").write_text(paper.replace("period_s = 0.005", "period_s = 0.001"), encoding="utf-8")
        with served_process(folder, "--config", "bench.toml") as url, browser() as chromium, _client(url) as client:
            yield from first_screen(chromium, url)
            yield from pages(client)
            _make_study(client)
            yield from study_page(chromium, url)
            yield from nodes_and_axe(chromium, url)
            yield from live(chromium, url, client)


def first_screen(chromium: Any, url: str) -> Iterator[Figure]:
    """Controls, words, time and bytes, before anything is pressed."""
    for width, height in ((1440, 900), (390, 844)):
        page = _open(chromium, url, "#home", width, height=height, token=False)
        page.locator(".badge.idle").wait_for()
        found = page.evaluate(FIRST_SCREEN)
        page.close()
        at = f"first screen, {width} x {height}"
        yield Figure(f"{at}: controls", "<= 12", f"{found['controls']}", found["controls"] <= 12)
        yield Figure(f"{at}: words", "<= 80", f"{found['words']}", found["words"] <= 80)
        painted_ms, sent_kb = found["painted_ms"], found["sent"] / 1e3
        yield Figure(f"{at}: painted after the answer", "<= 1000 ms", f"{painted_ms:.0f} ms", painted_ms <= 1000)
        yield Figure(f"{at}: transfer", "<= 700 kB", f"{sent_kb:.0f} kB", sent_kb <= 700)


def pages(client: httpx.Client) -> Iterator[Figure]:
    """A page of a long list, over REST."""
    for name, asked in PAGES.items():
        taken_ms = 1e3 * min(_timed(client, asked) for _ in range(REPEATS))
        what = f"{TRIALS} trials, a page of 50: {name}"
        yield Figure(what, "<= 200 ms", f"{taken_ms:.0f} ms", taken_ms <= 200)


def study_page(chromium: Any, url: str) -> Iterator[Figure]:
    """Height of each step of a study, details folded."""
    page = _open(chromium, url, "#study/1/compare", 1440)
    page.locator("table.heat button.cell").first.wait_for()
    heights = {}
    for number, step in enumerate(STEPS, 1):
        page.get_by_role("link", name=f"{number} {step.capitalize()}").click()
        if step == "diagnose":
            page.get_by_role("button", name="Diagnose").click()
            page.locator("article canvas.chart").first.wait_for()
        page.wait_for_timeout(1000)
        heights[step] = page.evaluate("document.documentElement.scrollHeight") / HEIGHT
    page.close()
    for step, screens in heights.items():
        yield Figure(f"study, step {step}: screens of 1440 x 900", "<= 2", f"{screens:.2f}", screens <= 2)


def nodes_and_axe(chromium: Any, url: str) -> Iterator[Figure]:
    """Size of the document, and rules of axe-core that are broken, in all views."""
    from axe_playwright_python.sync_playwright import Axe

    most, where, broken = 0, "", 0
    for width, scheme in SCHEMES:
        page = _open(chromium, url, "#home", width, scheme)
        for view in VIEWS:
            page.evaluate("(hash) => { location.hash = hash; }", view)
            page.locator("main :is(.panel, .door, .numbers)").first.wait_for()
            page.wait_for_timeout(1500)
            count = page.evaluate(NODES)
            if count > most:
                most, where = count, view
            broken += len(Axe().run(page).response["violations"])
        page.close()
    yield Figure(f"{TRIALS} trials: nodes in the DOM of any view", "< 1500", f"{most} ({where})", most < 1500)
    yield Figure("axe, all views, light and dark, 1440 and 390", "0", str(broken), broken == 0)


def live(chromium: Any, url: str, client: httpx.Client) -> Iterator[Figure]:
    """Pictures of the live plot a second, while rows come at 1 kHz; beside it what the browser could do."""
    page = _open(chromium, url, "#bench", 1440)
    page.locator(".badge.idle").wait_for()
    page.evaluate(COUNT_PICTURES)
    page.evaluate(COUNT_FRAMES)
    body = {"kind": "steps", "pace": "real-time", "parameters": {"repeats": 100}}
    client.post("/experiments", json=body).raise_for_status()
    page.wait_for_timeout(3000)
    begun_s, first = time.monotonic(), page.evaluate("[window.pictures, window.frames_seen]")
    page.wait_for_timeout(1000 * LIVE_S)
    last, taken_s = page.evaluate("[window.pictures, window.frames_seen]"), time.monotonic() - begun_s
    client.post("/stop").raise_for_status()
    page.close()
    plot, frames = ((after - before) / taken_s for before, after in zip(first, last, strict=True))
    words = f"{plot:.0f}, the browser's own frames {frames:.0f}"
    yield Figure("live plot at 1 kHz rows: pictures a second", ">= 30", words, plot >= 30)


def _timed(client: httpx.Client, asked: dict[str, Any]) -> float:
    begun_s = time.perf_counter()
    client.get("/trials/search", params=asked).raise_for_status()
    return time.perf_counter() - begun_s


def _make_study(client: httpx.Client) -> None:
    headers = {"Content-Type": "application/zip"}
    made = client.post("/recording-sets?name=known+joint", content=recording_set_zip(), headers=headers)
    body = {"name": "known joint", "experiment_ids": [made.json()["experiment_id"]], "hold_out": ["amplitude_rad=0.9"]}
    client.post("/studies", json=body).raise_for_status()


def _client(url: str) -> httpx.Client:
    return httpx.Client(base_url=f"{url}/api/v1", headers={"Authorization": f"Bearer {TOKEN}"}, timeout=120)


def _open(
    chromium: Any, url: str, view: str, width: int, scheme: str = "light", height: int = HEIGHT, token: bool = True
) -> Any:
    page = chromium.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
    page.set_default_timeout(120_000)
    if token:
        page.add_init_script(WITH_TOKEN)
    page.goto(f"{url}/{view}")
    return page


if __name__ == "__main__":
    main()
