"""STOP on the page, when things go wrong around it."""

import re

import pytest

from tests.service.running_service import running_service

pytestmark = pytest.mark.browser


def start(page) -> None:
    page.get_by_label("repeats").fill("20")
    page.get_by_role("button", name="Start", exact=True).click()
    page.locator(".badge.running").wait_for()


def test_a_stop_whose_request_hangs_is_asked_for_again_until_the_drive_confirms(service, open_page):
    page = open_page()
    start(page)
    hung = []

    def hang_once(route) -> None:
        if hung:
            route.continue_()
        else:
            hung.append(route)  # never answered

    page.route("**/api/v1/stop", hang_once)
    page.keyboard.press("Escape")
    page.get_by_text(re.compile("Stop NOT confirmed: no answer within .* Asking again")).wait_for()
    page.get_by_text("Stop accepted and confirmed: the drive is powered off").wait_for()
    assert service.runner.status().outcome == "stopped"


def test_a_stop_is_not_called_confirmed_while_the_run_goes_on(service, open_page):
    page = open_page()
    start(page)
    page.route("**/api/v1/stop", lambda route: route.fulfill(json={"detail": "Stop accepted.", "was_running": True}))
    page.keyboard.press("Escape")
    page.get_by_text("NOT confirmed by the drive within").wait_for()
    page.unroute("**/api/v1/stop")
    page.get_by_role("button", name="STOP").click()
    page.get_by_text("Stop accepted and confirmed").wait_for()


def test_other_requests_that_hang_do_not_hold_up_a_stop(service, open_page):
    page = open_page()
    start(page)
    page.route("**/api/v1/effects*", lambda route: None)
    page.evaluate(
        "import('/static/modules/api.js').then((api) => { for (let n = 0; n < 12; n++) api.get('/effects', {n}); })"
    )
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()


def test_a_failed_power_off_is_said(open_page):
    page = open_page()
    text, level = page.evaluate(
        "import('/static/modules/stop.js').then((stop) => stop.verdict("
        "{outcome: 'stopped', experiment_id: 3, reason: 'STOP on the page; power-off failed: no answer'}))"
    )
    assert level == "unconfirmed"
    assert "NOT confirmed by the drive: STOP on the page; power-off failed: no answer" in text


def test_the_page_goes_on_when_the_service_comes_back(tmp_path, chromium):
    """The service is restarted while somebody watches: stale meanwhile, then what is true now."""
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    second.mkdir()
    page = chromium.new_page()
    page.set_default_timeout(20_000)
    with running_service(first) as before:
        port = int(before.url.rsplit(":", 1)[1])
        page.goto(before.url)
        page.locator(".badge.idle").wait_for()
        before.run("steps", repeats=1)
        page.get_by_text("Experiment 1 (steps): completed").wait_for()
        before.client.close()
    page.get_by_text("STALE").wait_for()
    with running_service(second, port=port) as after:
        page.locator(".badge.idle").wait_for()
        page.get_by_text("Nothing has run yet", exact=False).first.wait_for()
        after.run("steps", repeats=1)
        page.get_by_text("Experiment 1 (steps): completed").wait_for()
        page.get_by_label("Live", exact=True).locator(".legend-entry").first.wait_for()
        page.close()
