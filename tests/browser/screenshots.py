"""Walks from a fresh service to an explained hidden effect: `python -m tests.browser.screenshots out/walk`.

It does what docs/tutorial/walk.md says, in the same order, and prints how long that took.
"""

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.browser.browser import WITH_TOKEN, browser
from tests.service.running_service import running_service

SEED = 13  # of the challenge: one that the lab explains; of 7 it names what is not there (see the blind benchmark)
SIZES = ((1280, "light"), (400, "dark"))
WAIT_MS = 120_000


def main() -> None:
    """Walk."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/walk")
    folder.mkdir(parents=True, exist_ok=True)
    begin_s = time.monotonic()
    with tempfile.TemporaryDirectory() as store, running_service(Path(store)) as service, browser() as chromium:
        page = open_page(chromium, f"{service.url}/#bench", 1280, "light")
        shot = _camera(page, folder)
        _bench(page, shot)
        study = _challenge(page, shot, service)
        print(f"from the first page to the explained effect: {time.monotonic() - begin_s:.0f} s")
        page.close()
        for width, scheme in SIZES:
            _every_view(open_page(chromium, service.url, width, scheme), folder, f"{width}-{scheme}", study)
    print(f"{len(list(folder.glob('*.png')))} pictures in {folder}")


def open_page(chromium: Any, url: str, width: int, scheme: str) -> Any:
    """A page of that width, with the token of the tests."""
    page = chromium.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.set_default_timeout(WAIT_MS)
    page.add_init_script(WITH_TOKEN)
    page.goto(url)
    return page


def _camera(page: Any, folder: Path) -> Callable[[str], None]:
    taken: list[str] = []

    def shot(name: str) -> None:
        taken.append(name)
        page.wait_for_timeout(800)  # the last plot is drawn
        page.screenshot(path=folder / f"walk-{len(taken):02d}-{name}.png")

    return shot


def _bench(page: Any, shot: Callable[[str], None]) -> None:
    page.locator(".badge.idle").wait_for()
    shot("bench")
    page.get_by_label("repeats").fill("2")
    page.get_by_role("button", name="Start", exact=True).click()
    page.get_by_text("B breakaway").wait_for()
    shot("running")
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()
    shot("stopped")


def _challenge(page: Any, shot: Callable[[str], None], service: Any) -> str:
    """From a challenge to its answer. Returns the study's address."""
    # made over REST for its seed; on the page: Learn, New challenge
    made = service.client.post("/challenges", json={"difficulty": "easy", "seed": SEED}, timeout=WAIT_MS / 1000)
    page.get_by_role("link", name="Learn").click()
    page.get_by_role("link", name=f"Study challenge {made.json()['challenge_id']}").wait_for()
    shot("challenge")
    page.get_by_role("link", name=f"Study challenge {made.json()['challenge_id']}").click()
    page.get_by_label("Name").fill("what is hidden?")
    page.get_by_role("button", name="Create study").click()
    page.locator("table.heat button.cell").first.wait_for()
    study = page.evaluate("location.hash")
    page.get_by_label("Where the model is wrong").scroll_into_view_if_needed()
    shot("compare")
    page.get_by_role("button", name="Simulate and refine").click()
    page.get_by_role("group", name="In closed loop").locator(".js-plotly-plot").first.wait_for()
    page.get_by_role("group", name="In closed loop").scroll_into_view_if_needed()
    shot("closed-loop")
    page.get_by_role("button", name="Diagnose").click()
    page.locator("article .js-plotly-plot").first.wait_for()
    page.locator("article").first.scroll_into_view_if_needed()
    shot("diagnosis")
    named = page.locator("article").first.get_attribute("aria-label")
    page.locator("article").first.get_by_role("button", name="Add").click()
    page.get_by_role("button", name="Undo this change").wait_for()
    shot("error-before-and-after")
    page.get_by_role("link", name="Learn").click()
    page.get_by_role("button", name="Guess at challenge").first.click()
    page.get_by_label("I say").select_option(label=named)
    page.get_by_role("button", name="Reveal").click()
    page.get_by_text("hidden", exact=False).last.wait_for()
    page.locator("[role=status]").last.scroll_into_view_if_needed()
    shot("revealed")
    return str(study)


def _every_view(page: Any, folder: Path, name: str, study: str) -> None:
    for view in ("#bench", "#queue", "#trials", "#study", study, "#learn", "#learn/backlash"):
        page.evaluate("(hash) => { location.hash = hash; }", view)
        page.locator("main .panel").first.wait_for()
        page.wait_for_timeout(2500)  # plots are drawn one after the other
        page.screenshot(path=folder / f"{view[1:].replace('/', '-')}-{name}.png", full_page=True)
    page.close()


if __name__ == "__main__":
    main()
