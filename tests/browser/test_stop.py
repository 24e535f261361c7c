"""STOP on the page, when things go wrong around it."""

import re

import pytest

from bench.service.auth.tokens import Role, digest_of, make_token
from tests.browser.browser import imported, intercept
from tests.service.running_service import running_service

pytestmark = pytest.mark.browser


def start(page, repeats: int = 20) -> None:
    page.get_by_label("repeats").fill(str(repeats))
    page.get_by_role("button", name="Start", exact=True).click()
    page.locator(".badge.running").wait_for()


def test_a_stop_whose_request_hangs_is_asked_for_again_until_the_drive_confirms(service, open_page):
    page = open_page()
    start(page)
    hung = []

    def hang_twice(route) -> None:
        if len(hung) == 2:
            route.continue_()
        else:
            hung.append(route)  # never answered; the sentence stands while the second one is waited for

    intercept(page, "**/api/v1/stop", hang_twice)
    page.keyboard.press("Escape")
    page.get_by_text(re.compile("Stop NOT confirmed: no answer within .* Asking again")).wait_for()
    page.get_by_text("Stop accepted and confirmed: the drive is powered off").wait_for()
    assert service.runner.status().outcome == "stopped"


def test_a_stop_is_not_called_confirmed_while_the_run_goes_on(service, open_page):
    page = open_page()
    start(page, repeats=400)  # it must not end by itself while the drive is asked, on the quickest machine
    intercept(
        page, "**/api/v1/stop", lambda route: route.fulfill(json={"detail": "Stop accepted.", "was_running": True})
    )
    page.keyboard.press("Escape")
    page.get_by_text("NOT confirmed by the drive within").wait_for()
    page.unroute("**/api/v1/stop")
    page.get_by_role("button", name="STOP").click()
    page.get_by_text("Stop accepted and confirmed").wait_for()


def test_other_requests_that_hang_do_not_hold_up_a_stop(service, open_page):
    page = open_page()
    start(page)
    intercept(page, "**/api/v1/effects*", lambda route: None)
    page.evaluate(
        f"{imported('app/api')}.then((api) => {{ for (let n = 0; n < 12; n++) api.get('/effects', {{n}}); }})"
    )
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()


def test_a_failed_power_off_is_said(open_page):
    page = open_page()
    level, text, experiment_id = page.evaluate(
        f"{imported('app/stop')}.then((stop) => stop.verdict("
        "{outcome: 'stopped', experiment_id: 3, power_off: 'failed', "
        "reason: 'STOP on the page; power-off failed: no answer'}))"
    )
    assert (level, experiment_id) == ("unconfirmed", 3)
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
        page.goto(f"{before.url}/#bench")
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


def test_another_one_has_the_bench_and_everybody_can_stop(service, open_page):
    """Two users: who does not have the bench is told so where it is started, and can stop."""
    page = open_page()
    page.get_by_text("The bench is free.").wait_for()
    page.get_by_role("button", name="Take the bench").click()
    page.get_by_text("You have the bench.").wait_for()
    assert service.client.get("/lease").json()["lease"]["token"] == "environment"
    page.get_by_role("button", name="Give it back").click()
    page.get_by_text("The bench is free.").wait_for()

    ada = make_token()
    service.store.access.tokens.add(f"ada {ada[:6]}", Role.OPERATOR, digest_of(ada))
    headers = {"Authorization": f"Bearer {ada}"}
    taken = service.stranger.post("/lease", json={"holder": "Ada, room 12"}, headers=headers)
    assert taken.status_code == 201, taken.text
    page.get_by_text("Ada, room 12 has the bench: you can watch and stop, not start.").wait_for()
    body = {"kind": "steps", "parameters": {"repeats": 20}, "pace": "real-time"}
    assert service.stranger.post("/experiments", json=body, headers=headers).status_code == 201
    page.locator(".badge.running").wait_for()
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()
    page.get_by_role("button", name="Start", exact=True).click()
    page.locator("form .problem").get_by_text("Ada, room 12").wait_for()
    service.stranger.delete("/lease", headers=headers)
    page.get_by_text("The bench is free.").wait_for()
    open_page.expected.append("409")


def test_whose_bench_it_is_is_read_whole_beside_the_form(service, open_page):
    """A browser without a token, while somebody else runs something: the name is said to be that of a token."""
    page = open_page(token=False)
    service.start("steps", pace="real-time", repeats=20)
    lease = page.get_by_text("Token 'environment' has the bench while the experiment runs: you can watch and stop")
    lease.wait_for()
    page.locator(".live .readings").get_by_text("position").wait_for()
    text, panel = lease.bounding_box(), page.get_by_label("Start an experiment", exact=True).bounding_box()
    assert text["x"] + text["width"] <= panel["x"] + panel["width"]
    assert lease.evaluate("(one) => one.scrollWidth <= one.clientWidth")
    service.client.post("/stop").raise_for_status()
    page.get_by_text("The bench is free.").wait_for()
