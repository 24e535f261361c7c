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
SIZES = ((1440, 900), (390, 844))
SCHEMES = ("light", "dark")
STEPS = ("record", "compare", "diagnose", "add", "result")
STUDY = tuple(f"#study/1/{step}" for step in STEPS)
VIEWS = ("#home", "#bench", "#commission", "#queue", "#trials/1", "#study", *STUDY, "#learn")
WORDS = "walk.txt"
WAIT_MS = 120_000
BUSY = "[aria-busy=true], main .busy"


def main() -> None:
    """Walk, and take every view."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/walk")
    seeded = patch.object(challenges.secrets, "randbits", lambda _bits: SEED)
    with tempfile.TemporaryDirectory() as store, running_service(Path(store)) as service, browser() as chromium, seeded:
        page = open_page(chromium, service.url, 1440, "light", token=False)
        take_walk(page, folder)
        print((folder / WORDS).read_text(), end="")
        page.close()
        take_views(lambda width, height: open_page(chromium, service.url, width, SCHEMES[0], height), folder)
    print(f"{len(list(folder.glob('*.png')))} pictures in {folder}")


def open_page(chromium: Any, url: str, width: int, scheme: str, height: int = 900, token: bool = True) -> Any:
    """A page of that size, with the token of the tests unless that is to be typed."""
    page = chromium.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
    page.set_default_timeout(WAIT_MS)
    if token:
        page.add_init_script(WITH_TOKEN)
    page.goto(url)
    return page


def take_walk(page: Any, folder: Path) -> Walker:
    """Go the walk, and keep a picture of each step; how long it took and the clicks stand beside them in words.

    Args:
        page: of a fresh service, at its address alone, without the token.
        folder: where the pictures go; made where it is missing.

    Returns:
        The user who has gone it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    begin_s = time.monotonic()
    walker = Walker(page, _camera(page, folder))
    watch_and_stop(walker)
    explain_a_challenge(walker)
    took = f"from the first page to the explained effect: {time.monotonic() - begin_s:.0f} s"
    (folder / WORDS).write_text(f"{took}\n{len(walker.clicks)} clicks: {', '.join(walker.clicks)}\n")
    return walker


def take_views(opened: Callable[[int, int], Any], folder: Path) -> list[str]:
    """A picture of every view, in all sizes and colours.

    Args:
        opened: opens a page, with the token, of a width and a height, on a service after the walk.
        folder: where the pictures go.

    Returns:
        Their names.
    """
    pages = {width: opened(width, height) for width, height in SIZES}
    for page in pages.values():
        page.set_default_timeout(WAIT_MS)  # both ask the lab at once
    return [name for view in VIEWS for name in _take_view(pages, view, folder)]


def _camera(page: Any, folder: Path) -> Callable[[str], None]:
    taken: list[str] = []

    def shot(name: str) -> None:
        taken.append(name)
        page.wait_for_timeout(800)  # the last plot is drawn
        page.screenshot(path=folder / f"walk-{len(taken):02d}-{name}.png")

    return shot


def _take_view(pages: dict[int, Any], view: str, folder: Path) -> list[str]:
    for page in pages.values():
        page.evaluate("(hash) => { location.hash = hash; }", view)
    for page in pages.values():
        page.locator("main :is(.panel, .door)").first.wait_for()
    page.wait_for_timeout(500)  # what the views ask for is on its way
    for page in pages.values():
        page.wait_for_function("(busy) => !document.querySelector(busy)", arg=BUSY)
    page.wait_for_timeout(2000)  # plots are drawn one after the other, in all pages at once
    for page in pages.values():
        page.evaluate("scrollTo({top: 0, behavior: 'instant'})")  # the bar sticks to the top of what is in sight
    taken = []
    for scheme in SCHEMES:
        for page in pages.values():
            page.emulate_media(color_scheme=scheme)
        page.wait_for_timeout(300)  # plots are drawn in other colours
        for width, page in pages.items():
            taken.append(f"{view[1:].replace('/', '-')}-{width}-{scheme}.png")
            page.screenshot(path=folder / taken[-1], full_page=True)
    return taken


if __name__ == "__main__":
    main()
