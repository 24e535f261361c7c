"""The queue and campaigns on the page: put in, seen, moved, removed, paused, gone on with."""

import re

import pytest

from tests.queue.waiting import wait_for

pytestmark = pytest.mark.browser


def clear(service) -> None:
    service.client.delete("/queue").raise_for_status()
    service.client.post("/stop").raise_for_status()
    service.runner.wait(60.0)
    service.client.post("/queue/resume").raise_for_status()  # a stop holds it


@pytest.fixture(autouse=True)
def empty(service):
    """Nothing runs, nothing waits, and what is put in starts at once; before and after."""
    clear(service)
    yield
    clear(service)


def waiting(service) -> list[dict]:
    return service.client.get("/queue").json()["waiting"]


def test_an_experiment_waits_in_the_queue_and_is_removed(service, open_page):
    page = open_page()
    page.get_by_label("repeats").fill("1000")
    page.get_by_role("button", name="Start", exact=True).click()
    page.locator(".badge.running").wait_for()
    page.get_by_role("button", name="Queue", exact=True).click()
    page.get_by_text("It is in the queue").wait_for()
    page.get_by_text("1 waiting").wait_for()
    page.get_by_role("button", name="Remove steps from the queue").click()
    page.get_by_text("nothing waits").wait_for()
    assert waiting(service) == []
    page.keyboard.press("Escape")
    page.get_by_text("Stop accepted and confirmed").wait_for()


def test_the_queue_is_paused_after_a_trial_gone_on_with_moved_and_cleared(service, open_page):
    long = {"kind": "steps", "parameters": {"repeats": 1000}, "pace": "fast"}
    others = [{"kind": kind, "parameters": {"repeats": 1}, "pace": "fast"} for kind in ("reversals", "chirp")]
    service.client.post("/queue", json={"items": [long, *others]}).raise_for_status()
    page = open_page("#queue")
    page.get_by_role("button", name="Pause after this trial").click()
    page.get_by_text("The queue is paused: paused by environment.").wait_for()
    assert service.runner.status().pausing == "paused"
    page.get_by_role("button", name="Run chirp at place 2 earlier").click()
    page.get_by_role("button", name="Run reversals at place 2 earlier").wait_for()
    assert [one["kind"] for one in waiting(service)] == ["chirp", "reversals"]
    page.get_by_role("button", name="Go on: the joint moves").click()
    page.get_by_text("steps runs from the queue; 2 waiting.", exact=True).wait_for()
    wait_for(lambda: service.runner.status().pausing == "")
    page.get_by_role("button", name="Remove all that waits").click()
    page.get_by_text("steps runs from the queue; nothing waits.", exact=True).wait_for()
    page.keyboard.press("Escape")
    page.get_by_role("region", name="Came out of the queue").get_by_text("stopped", exact=True).first.wait_for()


def test_a_campaign_is_planned_refused_where_it_is_wrong_and_run(service, open_page):
    page = open_page("#queue")
    page.get_by_label("What to do").select_option("steps")
    page.get_by_label("Values of parameter 1").fill("0, 5000")
    page.get_by_role("button", name="Plan", exact=True).click()
    page.get_by_text(re.compile("load_kg is 5 kg; allowed is at most 0.1 kg")).wait_for()
    page.get_by_label("Values of parameter 1").fill("0, 100")
    page.get_by_role("button", name="Vary another one").click()
    page.get_by_label("Parameter 2", exact=True).select_option("angle_rad")
    page.get_by_label("Values of parameter 2").fill("60, 90")
    page.get_by_text("What all share").click()
    page.get_by_label("repeats", exact=True).fill("1")
    page.get_by_role("button", name="Plan", exact=True).click()
    page.get_by_text(re.compile("4 experiments, about .* something is hung 2 times")).wait_for()
    assert page.locator("[aria-label='Plan of the campaign'] tbody tr").count() == 4
    assert waiting(service) == []
    page.get_by_role("button", name="Put into the queue").click()
    page.get_by_text("4 experiments are in the queue.").wait_for()
    ended = page.get_by_role("region", name="Came out of the queue")
    ended.get_by_text("load 100 g").nth(1).wait_for()
    ended.get_by_text("completed", exact=True).nth(3).wait_for()
    done = [one for one in service.client.get("/queue").json()["ended"] if one["campaign_id"]][:4]
    assert {(one["parameters"]["load_kg"], one["parameters"]["angle_rad"]) for one in done} == {
        (load_kg, angle_rad) for load_kg in (0.0, 0.1) for angle_rad in (1.0471975512, 1.57079632679)
    }
    assert {one["state"] for one in done} == {"completed"}
    open_page.expected.append("422")
