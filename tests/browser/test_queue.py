"""The queue on the page: put in, seen, removed."""

import pytest

pytestmark = pytest.mark.browser


def test_an_experiment_waits_in_the_queue_and_is_removed(service, open_page):
    service.runner.wait(60.0)
    service.client.delete("/queue")
    page = open_page()
    page.get_by_label("repeats").fill("20")
    page.get_by_role("button", name="Start", exact=True).click()
    page.locator(".badge.running").wait_for()
    page.get_by_role("button", name="Queue", exact=True).click()
    page.get_by_text("It is in the queue").wait_for()
    page.get_by_text("1 waiting").wait_for()
    page.get_by_role("button", name="Remove steps from the queue").click()
    page.get_by_text("nothing waits").wait_for()
    assert service.client.get("/queue").json()["waiting"] == []
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()
