"""Chromium for commands and tests: where it is, and how it is started."""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from tests.service.running_service import TOKEN

# the same engine without the windows of a desktop is first: it starts and opens a page in two thirds of the time
NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
CHROMIUM = next((path for name in NAMES if (path := shutil.which(name))), None)
HOW_TO_GET_IT = "Chromium is not installed; on Debian: apt-get install chromium-headless-shell"
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
PROBE = "/static/style.css?probe"
WITH_TOKEN = f"sessionStorage.setItem('friction-bench-token', '{TOKEN}')"


def imported(module: str) -> str:
    """JavaScript that imports a module of the page, such as "plots/thin": the one that the page itself uses."""
    return f"import(document.querySelector('script[type=module]').src.replace('app/main', '{module}'))"


def intercept(page: Any, pattern: str, answer: Callable[[Any], None]) -> None:
    """`page.route` for a page that is open already; comes back once it holds.

    Chromium tells the page's process of the interception without waiting for it: what the page asks for at once, such
    as a key's request, still goes to the service, seldom, and more often on a busy machine.
    """
    page.route(_is_probe, lambda route: route.fulfill(body="held"))
    page.route(pattern, answer)
    page.evaluate(f"async () => {{ while (await (await fetch('{PROBE}', {{cache: 'no-store'}})).text() !== 'held'); }}")
    page.unroute(_is_probe)


def _is_probe(url: str) -> bool:
    return url.endswith(PROBE)


@contextmanager
def browser(*arguments: str) -> Iterator[Any]:
    """A browser, for a command."""
    from playwright.sync_api import sync_playwright

    if CHROMIUM is None:
        raise SystemExit(HOW_TO_GET_IT)
    with sync_playwright() as driver:
        opened = driver.chromium.launch(executable_path=CHROMIUM, args=[*ARGUMENTS, *arguments])
        yield opened
        opened.close()
