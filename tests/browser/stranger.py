"""A stranger's way from the page's address to a challenge that is revealed: `python -m tests.browser.stranger 1 2 3`.

Nothing is known but the address and the token; the page is followed by what it offers. Each number is the seed of one
challenge, on a service and a store of its own. What was pressed, when, and what the page said is printed.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.browser.browser import browser
from tests.browser.screenshots import WAIT_MS, open_page
from tests.browser.walk import Walker
from tests.service.running_service import TOKEN
from tests.service.served_process import served_process

MOST_ROUNDS = 3  # of diagnosing and adding
MOST_CLICKS, MOST_S = 20, 480
CANDIDATE = ".diagnosed article:has(.badge.completed) button.add"


def main() -> None:
    """Go the way for each seed, and print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("seeds", type=int, nargs="+", help="of the challenges")
    parser.add_argument("--width", type=int, default=1440)
    arguments = parser.parse_args()
    for seed in arguments.seeds:
        with tempfile.TemporaryDirectory() as at, served_process(Path(at)) as url, browser() as chromium:
            page = open_page(chromium, url, arguments.width, "light", token=False)
            page.route("**/api/v1/challenges", _seeding(seed))
            begun_s = time.monotonic()
            walker = Walker(page, lambda _name: None)
            said = _way(walker)
            taken_s = time.monotonic() - begun_s
        met = len(walker.clicks) <= MOST_CLICKS and taken_s <= MOST_S
        print(f"challenge {seed}: {len(walker.clicks)} clicks (asked {MOST_CLICKS}), {taken_s:.0f} s (asked {MOST_S})")
        print(f"  pressed: {'; '.join(walker.clicks)}")
        for sentence in said:
            print(f"  {sentence}")
        if not met:
            print("  NOT MET")


def _seeding(seed: int) -> Callable[[Any], None]:
    def handle(route: Any) -> None:
        if route.request.method != "POST":
            route.fallback()
            return
        route.continue_(post_data=json.dumps({**route.request.post_data_json, "seed": seed}))

    return handle


def _way(walker: Walker) -> list[str]:
    """What the page said on the way: diagnoses, verdict of the study, and what was revealed."""
    page, said = walker.page, []
    walker.link("Find a hidden effect")
    walker.button("New challenge")
    page.get_by_text("This needs the token").wait_for()
    page.get_by_label("Token: to start").fill(TOKEN)
    walker.button("Use token")
    page.get_by_text("is ready. Make a study").wait_for()
    walker.link("Study challenge")
    page.locator("form .good, form .problem").get_by_text("model").first.wait_for()
    walker.press(page.locator("#study-create"), "Create study")
    page.locator("table.heat button.cell").first.wait_for()
    for _ in range(MOST_ROUNDS):
        walker.link("3 Diagnose")
        walker.press(page.locator("#diagnose-now"), "Diagnose")
        page.locator(".diagnosed .sentence").wait_for()
        page.locator(".diagnosed article").first.wait_for()
        said.append(page.locator(".diagnosed .sentence").inner_text())
        candidate = page.locator(CANDIDATE).first
        if not candidate.count():
            break
        walker.press(candidate, candidate.inner_text())
        page.get_by_role("button", name="Undo this change").wait_for()
        page.locator(".study-plots").get_by_text("predicted before").wait_for()
    said.append(page.locator(".study-head .sentence").inner_text())
    finish = page.locator(".diagnosed .finish .primary")
    if finish.count():
        walker.press(finish, finish.inner_text())
    else:
        walker.link("Learn")
        walker.button("Guess at challenge")
    page.get_by_label("or what a study").wait_for()
    walker.press(page.get_by_role("button", name="Reveal", exact=True), "Reveal")
    page.locator(".revealed").wait_for(timeout=WAIT_MS)
    return [*said, *page.locator(".guess form > div").last.inner_text().splitlines()]


if __name__ == "__main__":
    main()
