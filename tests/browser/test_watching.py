"""Who watches a run: what is asked of them, what they see who come late, what stays while they look."""

import re
import zipfile

import pytest

from bench.control import station
from bench.control.drive_factory import Equipment
from bench.control.technician import PersonTechnician
from tests.control.fake_drive import FakeDrive
from tests.service.running_service import TOKEN

pytestmark = pytest.mark.browser
SHIFTS = """new Promise((resolve) => {
  const shifts = [];
  new PerformanceObserver((list) => {
    for (const one of list.getEntries().filter((each) => !each.hadRecentInput))
      shifts.push([one.value, one.sources.map((source) => source.node?.outerHTML?.slice(0, 120))]);
  }).observe({ type: 'layout-shift', buffered: true });
  setTimeout(() => resolve(shifts), 300);
})"""
FRAME = "() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))"
LEFT_PX, RIGHT_PX = 78, 10  # of the axis, in paint.js
MOST_SHIFT = 0.1  # what is called good: https://web.dev/articles/cls


@pytest.fixture(autouse=True)
def ended(service):
    """Whatever a test leaves running."""
    yield
    service.client.post("/stop").raise_for_status()
    assert service.runner.wait(60.0)


def shift(page) -> tuple[float, list]:
    found = page.evaluate(SHIFTS)
    return sum(value for value, _ in found), found


def time_at(page, share: float) -> float:
    """Time [s] of the reading under the pointer, at a share of the live plot's width."""
    chart = page.get_by_label("Live", exact=True).locator("canvas.chart")
    box = chart.bounding_box()
    chart.hover(position={"x": LEFT_PX + share * (box["width"] - LEFT_PX - RIGHT_PX), "y": box["height"] / 2})
    values = page.get_by_label("Live", exact=True).locator(".values")
    values.get_by_text(re.compile(r"position")).wait_for()
    page.evaluate(FRAME)
    return float(values.inner_text().split(":")[0])


def test_what_the_bench_asks_of_its_person_is_said_in_every_view_and_answered_once(service, open_page, monkeypatch):
    drive = FakeDrive()
    monkeypatch.setattr(station, "make_equipment", lambda _configuration, ask: Equipment(drive, PersonTechnician(ask)))
    page, other = open_page("#study"), open_page("#bench")
    service.start("steps", repeats=1)
    for each in (page, other):
        each.get_by_text("Hang 100 g at the tip of the arm, and stand clear.").wait_for()
    assert drive.exchanges == 0
    page.get_by_role("button", name="Continue").click()
    for each in (page, other):
        each.get_by_text("Hang 100 g at the tip of the arm").wait_for(state="detached")
    for _ in range(600):
        if drive.exchanges:
            break
        page.wait_for_timeout(50)
    assert drive.exchanges > 0


def begin_long_trial(service, page) -> None:
    """One that lasts longer than any test."""
    service.start("hold-and-soak", pace="real-time", soak_s=300.0)
    page.get_by_label("Live", exact=True).locator(".legend-entry").get_by_text("position").wait_for()
    wait_until_shown(page, 1.0)


def wait_until_shown(page, after_s) -> None:
    """The picture's end, in the trial's time."""
    for _ in range(300):
        if time_at(page, 1.0) > after_s:
            return
        page.wait_for_timeout(100)
    raise AssertionError(f"no rows after {after_s} s came")


def test_who_comes_late_sees_the_trial_from_its_beginning(service, open_page):
    begin_long_trial(service, open_page())
    late = open_page()
    late.get_by_label("Live", exact=True).locator(".legend-entry").get_by_text("position").wait_for()
    wait_until_shown(late, 1.0)
    assert time_at(late, 0.0) < 0.1


def test_a_frozen_picture_stays_while_the_joint_goes_on(service, open_page):
    page = open_page()
    begin_long_trial(service, page)
    page.get_by_label("freeze").check()
    then_s = time_at(page, 1.0)
    page.wait_for_timeout(500)
    assert time_at(page, 1.0) == then_s
    page.get_by_role("button", name="Zoom in").click()  # to look closer is what it is for
    assert time_at(page, 1.0) < then_s
    page.get_by_role("button", name="Show all").click()
    page.get_by_label("freeze").uncheck()
    wait_until_shown(page, then_s)


def test_the_load_is_followed_with_its_band(service, open_page):
    page = open_page()
    page.get_by_role("button", name="Start", exact=True).wait_for()
    service.start("steps", pace="real-time", repeats=30)
    live = page.get_by_label("Live", exact=True)
    live.locator(".legend-entry").get_by_text("load current (band: 95 %)").wait_for()
    live.locator(".readings").get_by_text(re.compile(r"^−?\d\.\d{3} ± 0\.\d{3} A$")).wait_for()
    page.wait_for_timeout(1500)  # the arm is on its way to the next step
    assert live.locator(".readings").get_by_text("load current, as last found").is_visible()


@pytest.mark.parametrize("width", [1280, 400])
@pytest.mark.parametrize("view", ["#bench", "#queue", "#trials", "#study", "#learn", "#learn/backlash"])
def test_nothing_jumps_while_a_view_fills(service, open_page, width, view):
    if not service.client.get("/trials", params={"limit": 1}).json()["items"]:
        service.run("steps", repeats=1)
    page = open_page(view, width=width)
    page.locator("main .panel").first.wait_for()
    for busy in page.locator("main .busy").all():
        busy.wait_for(state="detached")
    moved, what = shift(page)
    assert moved < MOST_SHIFT, what


def test_nothing_jumps_while_a_run_goes_on(service, open_page):
    page = open_page()
    page.get_by_role("button", name="Start", exact=True).wait_for()
    service.start("steps", pace="real-time", repeats=1)
    page.get_by_text("B breakaway").wait_for()
    moved, what = shift(page)
    assert moved < MOST_SHIFT, what


def test_the_token_stands_in_no_address(service, open_page):
    page = open_page("#trials")
    asked = []
    page.on("request", lambda request: asked.append(request.url))
    experiment = service.run("steps", repeats=1)["experiment_id"]
    for view in ("#bench", "#queue", "#study", "#learn", "#trials"):
        page.evaluate("(hash) => { location.hash = hash; }", view)
        page.locator("main .panel").first.wait_for()
    row = page.get_by_role("button", name=f"Recording set of experiment {experiment}", exact=True)
    with page.expect_download() as download:
        row.click()
    assert zipfile.is_zipfile(download.value.path())
    assert any("/recording-set" in url for url in asked)
    assert not [url for url in [page.url, *asked] if TOKEN in url]
    assert TOKEN not in page.evaluate("JSON.stringify(localStorage) + document.cookie")


def test_the_lowest_of_the_live_plots_is_not_cut_by_its_card(service, open_page):
    page = open_page("#bench", width=1440)
    service.start("steps", pace="real-time", repeats=3)  # the trial that has ended takes of their room
    canvas = page.get_by_label("Live", exact=True).locator("canvas.chart")
    canvas.wait_for()
    page.evaluate(FRAME)
    card = page.get_by_label("Live", exact=True)
    assert card.evaluate("(one) => one.scrollHeight - one.clientHeight") <= 1
    inside, plots = card.bounding_box(), canvas.bounding_box()
    assert plots["y"] + plots["height"] <= inside["y"] + inside["height"]
    assert plots["height"] >= 320  # four rows, each to be read
    assert page.evaluate("document.querySelector('main canvas.chart').height / devicePixelRatio") == pytest.approx(
        plots["height"], abs=1
    )
