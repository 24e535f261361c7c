"""Chromium for commands and tests: where it is, and how it is started."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from tests.service.running_service import TOKEN

# the same engine without the windows of a desktop is first: it starts and opens a page in two thirds of the time
NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
CHROMIUM = next((path for name in NAMES if (path := shutil.which(name))), None)
HOW_TO_GET_IT = "Chromium is not installed; on Debian: apt-get install chromium-headless-shell"
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"]
WITH_TOKEN = f"sessionStorage.setItem('friction-bench-token', '{TOKEN}')"


def imported(module: str) -> str:
    """JavaScript that imports a module of the page, such as "plots/thin": the one that the page itself uses."""
    return f"import(document.querySelector('script[type=module]').src.replace('app/main', '{module}'))"


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
