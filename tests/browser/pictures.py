"""The pictures of README.md and of the walk: `python -m tests.browser.pictures docs/pictures`.

The first page; a joint under test; a study of a challenge with a fixed seed, whose recordings tell nothing of the
answer: where its model is wrong, the hidden effect that the lab has named, and where that acts.
"""

import sys
import tempfile
from pathlib import Path
from typing import Any

from tests.browser.browser import browser
from tests.browser.screenshots import SEED, WAIT_MS, open_page
from tests.service.running_service import RunningService, running_service

LARGEST_BYTES = 150_000
DRAWN_MS = 1500  # the last plot is drawn


def main() -> None:
    """Take the pictures.

    Raises:
        SystemExit: a picture has become too large for the repository.
    """
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as store, running_service(Path(store)) as service, browser() as chromium:
        page = open_page(chromium, f"{service.url}/#home", 1100, "light", height=620)
        _home(page, folder / "home.png")
        page = open_page(chromium, f"{service.url}/#bench", 1100, "light", height=840)
        _bench(page, folder / "page.png")
        _study(page, service, folder)
    refuse_large(folder)


def refuse_large(folder: Path) -> None:
    """Say how large the pictures of a folder are.

    Raises:
        SystemExit: one is too large for the repository.
    """
    for picture in sorted(folder.glob("*.png")):
        size = picture.stat().st_size
        print(f"{picture}: {size / 1e3:.0f} kB")
        if size > LARGEST_BYTES:
            raise SystemExit(f"{picture} has {size} bytes; allowed are {LARGEST_BYTES}. Show less")


def _home(page: Any, picture: Path) -> None:
    """The first page, before anything is pressed."""
    page.locator(".badge.idle").wait_for()
    page.wait_for_timeout(DRAWN_MS)
    page.screenshot(path=picture)


def _bench(page: Any, picture: Path) -> None:
    """The view Bench at the end of a short run."""
    page.locator(".badge.idle").wait_for()
    page.get_by_label("repeats").fill("1")
    page.get_by_role("button", name="Start", exact=True).click()
    page.get_by_text("B breakaway").wait_for()
    page.locator(".badge.idle").wait_for()
    page.wait_for_timeout(DRAWN_MS)
    page.screenshot(path=picture)


def _study(page: Any, service: RunningService, folder: Path) -> None:
    """Where the model of a challenge is wrong, what the lab names, and where that acts."""
    made = service.client.post("/challenges", json={"difficulty": "easy", "seed": SEED}, timeout=WAIT_MS / 1000)
    page.get_by_role("link", name="Learn").click()
    page.get_by_role("link", name=f"Study challenge {made.json()['challenge_id']}").click()
    page.get_by_label("Name").fill("what is hidden?")
    page.get_by_role("button", name="Create study").click()
    page.locator("table.heat button.cell.worst").click()
    page.get_by_role("region", name="Moments").wait_for()
    page.evaluate("scrollTo(0, 0)")
    page.wait_for_timeout(DRAWN_MS)
    page.screenshot(path=folder / "study.png", clip={"x": 0, "y": 60, "width": 1100, "height": 780})
    page.get_by_role("link", name="3 Diagnose").click()
    page.get_by_role("button", name="Diagnose").click()
    page.locator("article canvas.chart").first.wait_for()
    page.wait_for_timeout(DRAWN_MS)
    page.locator("article").first.screenshot(path=folder / "hidden-effect.png")
    page.get_by_role("button", name="Show where").first.click()
    page.get_by_text("predicted with the effect").wait_for()
    page.wait_for_timeout(DRAWN_MS)
    page.get_by_role("group", name="Measured against predicted").screenshot(path=folder / "acts.png")


if __name__ == "__main__":
    main()
