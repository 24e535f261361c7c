from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from tests.browser.browser import ARGUMENTS, CHROMIUM, HOW_TO_GET_IT, WITH_TOKEN
from tests.commission.scripted import scripted_service
from tests.service.running_service import RunningService, running_service


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningService]:
    with running_service(tmp_path_factory.mktemp("browser")) as running:
        # the first run of a process compiles: a stop of it is confirmed late, which the page says as of any other
        running.run("steps", repeats=1)
        yield running


@pytest.fixture
def commissioning(tmp_path: Path) -> Iterator[RunningService]:
    """A service on a joint that is not known; its commissioning asks, and moves nothing."""
    with scripted_service(tmp_path) as running:
        yield running


@pytest.fixture(scope="package")
def chromium(service: RunningService) -> Iterator[Any]:
    """One browser context for all tests; session storage is each page's own."""
    if CHROMIUM is None:
        pytest.skip(HOW_TO_GET_IT)
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    with playwright.sync_playwright() as driver:
        # one process draws all pages, as long as one of them is open: to start one takes longer than most tests
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=[*ARGUMENTS, "--process-per-site"])
        context = browser.new_context()
        context.new_page().goto(f"{service.url}/static/style.css")
        yield context
        browser.close()


def complaints_of(message: Any) -> list[str]:
    """Errors of any kind, and what plotly says of the content security policy; with the path that it is about."""
    is_complaint = message.type == "error" or "CSP" in message.text
    return [f"{message.text} [{urlsplit(message.location.get('url', '')).path}]"] if is_complaint else []


class Pages:
    """Opens pages, and keeps what they complain about: errors, policy violations.

    Args:
        context: the browser's.
        service: whose page is opened, unless another one is named.
    """

    def __init__(self, context: Any, service: RunningService) -> None:
        self._context, self._service = context, service
        self._opened: list[Any] = []  # pages and contexts
        self.complaints: list[str] = []
        self.expected: list[str] = []  # parts of complaints that are a test's own doing, whenever they come

    def __call__(
        self,
        view: str = "#bench",
        token: bool = True,
        width: int = 1280,
        scheme: str = "light",
        height: int = 900,
        service: RunningService | None = None,
        apart: bool = False,
    ) -> Any:
        """A page; `apart`: for several at once. All of a context share six connections, and each listens on one."""
        context = self._context.browser.new_context() if apart else self._context
        page = context.new_page()
        self._opened.append(context if apart else page)
        page.set_viewport_size({"width": width, "height": height})
        page.emulate_media(color_scheme=scheme)
        if token:
            page.add_init_script(WITH_TOKEN)
        page.set_default_timeout(45_000)  # of a loaded machine; nothing here takes a second by itself
        page.on("console", lambda message: self.complaints.extend(complaints_of(message)))
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.goto(f"{(service or self._service).url}/{view}")
        return page

    def say_what_they_show(self) -> None:
        """Into the report of a test that failed: the bench, each page, and what had the focus."""
        print(self._service.runner.status())
        for one in self._opened:
            for page in getattr(one, "pages", [one]):
                focus = page.evaluate("document.activeElement.outerHTML.slice(0, 200)")
                print(page.url, page.locator("body").inner_text()[:2000], focus, self.complaints, sep="\n")

    def close(self) -> None:
        for one in self._opened:
            one.close()

    @property
    def unexpected(self) -> list[str]:
        """What was complained about, but for what a test brought about."""
        return [one for one in self.complaints if not any(part in one for part in self.expected)]


FAILED = pytest.StashKey[bool]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    if report.when == "call":
        item.stash[FAILED] = report.failed
    return report


@pytest.fixture
def open_page(request: pytest.FixtureRequest, chromium: Any, service: RunningService) -> Iterator[Pages]:
    """Opens the page; at the end of the test, nothing may have been complained about."""
    pages = Pages(chromium, service)
    yield pages
    if request.node.stash.get(FAILED, False):
        pages.say_what_they_show()
    pages.close()
    assert pages.unexpected == []


@pytest.fixture(scope="module")
def shared_pages(chromium: Any, service: RunningService) -> Iterator[Pages]:
    """The same for tests that leave a page as it was; each of them looks at the complaints itself, too."""
    pages = Pages(chromium, service)
    yield pages
    pages.close()
    assert pages.complaints == []
