"""Walks from a fresh service to an explained hidden effect: `python -m tests.browser.screenshots out/walk`.

It goes the walk of docs/tutorial/walk.md, and prints how long that took and how many clicks; then every view is taken.
"""

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

from bench.service.routes import challenges
from tests.browser.browser import WITH_TOKEN, browser
from tests.browser.walk import Walker, explain_a_challenge, watch_and_stop
from tests.service.running_service import running_service

SEED = 13  # of the challenge: one that the lab explains; of 7 it names what is not there (see the blind benchmark)
SIZES = ((1440, 900, "light"), (1440, 900, "dark"), (390, 844, "light"), (390, 844, "dark"))
STEPS = ("record", "compare", "diagnose", "add", "result")
STUDY = tuple(f"#study/1/{step}" for step in STEPS)
VIEWS = ("#home", "#bench", "#commission", "#queue", "#trials/1", "#study", *STUDY, "#learn")
WAIT_MS = 120_000


def main() -> None:
    """Walk."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/walk")
    folder.mkdir(parents=True, exist_ok=True)
    begin_s = time.monotonic()
    seeded = patch.object(challenges.secrets, "randbits", lambda _bits: SEED)
    with tempfile.TemporaryDirectory() as store, running_service(Path(store)) as service, browser() as chromium, seeded:
        page = open_page(chromium, service.url, 1440, "light", token=False)
        walker = Walker(page, _camera(page, folder))
        watch_and_stop(walker)
        explain_a_challenge(walker)
        print(f"from the first page to the explained effect: {time.monotonic() - begin_s:.0f} s")
        print(f"{len(walker.clicks)} clicks: {', '.join(walker.clicks)}")
        page.close()
        pages = {
            f"{width}-{scheme}": open_page(chromium, service.url, width, scheme, height=height)
            for width, height, scheme in SIZES
        }
        for view in VIEWS:
            _view(pages, view, folder)
    print(f"{len(list(folder.glob('*.png')))} pictures in {folder}")


def open_page(chromium: Any, url: str, width: int, scheme: str, height: int = 900, token: bool = True) -> Any:
    """A page of that size, with the token of the tests unless that is to be typed."""
    page = chromium.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
    page.set_default_timeout(WAIT_MS)
    if token:
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


def _view(pages: dict[str, Any], view: str, folder: Path) -> None:
    for page in pages.values():
        page.evaluate("(hash) => { location.hash = hash; }", view)
    for page in pages.values():
        page.locator("main :is(.panel, .door)").first.wait_for()
    page.wait_for_timeout(4000)  # plots are drawn one after the other, in all pages at once
    for name, page in pages.items():
        page.screenshot(path=folder / f"{view[1:].replace('/', '-')}-{name}.png", full_page=True)


if __name__ == "__main__":
    main()
