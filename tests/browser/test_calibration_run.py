"""A sequential calibration on the page: begun, paused, gone on with, ended, and its curves shown."""

import pytest

from tests.service.running_service import running_service

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]


@pytest.fixture
def bench(tmp_path):
    with running_service(tmp_path) as running:
        yield running


def test_it_is_paused_gone_on_with_and_its_curves_are_shown(bench, open_page):
    page = open_page("#trials", service=bench)
    page.get_by_label("Known to [mA]").fill("1000")
    page.get_by_label("Time for the curves [min]").fill("0.5")
    page.get_by_role("button", name="Measure: the joint moves").click()
    page.get_by_role("button", name="Pause after this trial").click()
    page.get_by_text("It is paused, with the power off.").wait_for()
    assert page.get_by_text("of the joint's time left.").is_visible()
    assert 0.0 <= page.get_by_label("Share of the longest time").evaluate("(bar) => bar.value") < 1.0
    page.get_by_role("button", name="Go on: the joint moves").click()
    page.get_by_text("Calibration 1 is there.").wait_for(timeout=120_000)
    page.get_by_role("heading", name="Calibration 1").wait_for()
    page.get_by_role("button", name="Measure: the joint moves").wait_for()


def test_escape_ends_it_and_the_page_offers_to_go_on(bench, open_page):
    page = open_page("#trials", service=bench)
    page.get_by_label("Known to [mA]").fill("0.1")
    page.get_by_label("Time for the curves [min]").fill("60")
    page.get_by_role("button", name="Measure: the joint moves").click()
    page.get_by_text("speeds next").wait_for()
    page.keyboard.press("Escape")
    page.get_by_text("Not calibrated").wait_for()
    page.get_by_role("button", name="Go on with what was measured: the joint moves").wait_for()
