"""The pictures of docs/how-to/own-joint.md: `python -m tests.browser.commission_pictures docs/pictures`.

A simulated device is commissioned on the page, in real time, and each step is taken as its person sees it. On a machine
that is busy with other work the bench may be refused for late cycles; then take them again.
"""

import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from tests.browser.browser import browser
from tests.browser.pictures import refuse_large
from tests.browser.screenshots import open_page
from tests.commission.over_rest import PATIENCE_S, Hands, bench, is_over
from tests.service.running_service import RunningService

WIDTH = 1000
ASKED = {"arm_length_m": "know", "hand_angle_deg": "scale", "clear": "push", "hang": "weigh", "first_load_kg": "try"}
"""Questions that are taken, and the names of their pictures."""
DRAWN_MS = 500


class Photographer:
    """Answers on the page, and takes each picture once.

    Args:
        page: at the view.
        folder: where they go.
    """

    def __init__(self, page: Any, folder: Path) -> None:
        self._page, self._folder = page, folder
        self._taken: set[str] = set()

    def take(self, name: str) -> None:
        """The panel of the step, and what was found so far."""
        if name in self._taken:
            return
        self._taken.add(name)
        self._page.wait_for_timeout(DRAWN_MS)
        self._page.locator("main > .panel").first.screenshot(path=self._folder / f"commission-{name}.png")

    def answer(self, key: str, value: float | None) -> None:
        """The question that is shown."""
        place = self._page.locator(f"[data-question={key}]")
        place.wait_for()
        if key in ASKED:
            self.take(ASKED[key])
        if value is not None:
            self._page.locator("#answer").fill(f"{value:g}")
            place.get_by_role("button", name="Answer").click()
        else:
            place.get_by_role("button", name="Not known" if place.locator("input").count() else "Done").click()
        place.wait_for(state="detached")


def walk(service: RunningService, hands: Hands, photographer: Photographer) -> dict[str, Any]:
    """From the first question to the end; the state there."""
    deadline_s = time.monotonic() + PATIENCE_S
    while not is_over(found := service.client.get("/commission").json()):
        asked = found["question"] or found["prompt"]
        if asked is not None:
            key = asked.get("key", "hang")
            photographer.answer(key, hands.do(key, asked["sentence"]))
            deadline_s = time.monotonic() + PATIENCE_S
        elif found["step"] == "signs" and service.runner.status().outcome == "running":
            photographer.take("signs")
        elif time.monotonic() > deadline_s:
            raise SystemExit(f"nothing happens any more at step '{found['step']}'")
        time.sleep(0.1)
    return found


def main() -> None:
    """Take all.

    Raises:
        SystemExit: the commissioning was refused, or a picture is too large.
    """
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs/pictures")
    folder.mkdir(parents=True, exist_ok=True)
    with (
        tempfile.TemporaryDirectory() as store,
        bench(Path(store), "modbus", "--transport", "tcp") as (service, device),
        browser() as chromium,
    ):
        page = open_page(chromium, f"{service.url}/#commission", WIDTH, "light", height=800)
        photographer = Photographer(page, folder)
        page.get_by_role("button", name="Begin").wait_for()
        photographer.take("begin")
        page.get_by_role("button", name="Begin").click()
        ended = walk(service, Hands(device), photographer)
        if ended["refusal"]:
            raise SystemExit(f"not commissioned: {ended['refusal']}")
        page.get_by_role("button", name="Download bench.toml").wait_for()
        photographer.take("end")
        page.set_viewport_size({"width": 1400, "height": 800})
        page.locator("main > .panel").nth(1).screenshot(path=folder / "commission-found.png")
    refuse_large(folder)


if __name__ == "__main__":
    main()
