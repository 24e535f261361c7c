"""Before a study is made: what its trials can carry; after: what is offered for them."""

import re

import pytest

from tests.browser.browser import intercept
from tests.service.recorded_joint import recording_set_zip

pytestmark = pytest.mark.browser


def test_trials_that_cannot_carry_a_model_are_said_before_a_study_is_made(service, open_page):
    swept = [service.run("load-sweep", loads_kg=[0.0, 0.05, 0.1], repeats=1)["experiment_id"] for _ in range(3)]
    before = service.client.get("/studies").json()["items"]
    page = open_page("#study")
    for experiment in swept:
        page.get_by_label(f"{experiment}: load-sweep").check()
    page.locator("form .problem").get_by_text(re.compile("too few, about \\d+ are wanted")).wait_for()
    page.get_by_role("button", name="Create study all the same").wait_for()
    assert service.client.get("/studies").json()["items"] == before


def test_trials_of_another_joint_are_studied_and_no_more_are_suggested_for_it(service, open_page):
    headers = {"Content-Type": "application/zip"}
    made = service.client.post("/recording-sets?name=elsewhere", content=recording_set_zip(), headers=headers).json()
    page = open_page(f"#study/new/{made['experiment_id']}")
    page.locator("form .good").get_by_text("enough to fit a model").wait_for()
    page.get_by_text("Worth holding out").wait_for()
    page.get_by_role("button", name="Create study", exact=True).click()
    page.get_by_role("link", name="1 Record").click()
    page.get_by_text("their joint does not stand on this bench").wait_for()
    assert page.get_by_role("button", name="Suggest trials").count() == 0
    address = page.url
    page.get_by_role("link", name="5 Result").click()
    page.get_by_role("region", name="Parameters").get_by_text("N m s²/rad").first.wait_for()
    page.go_back()
    page.get_by_text("their joint does not stand on this bench").wait_for()
    assert page.url == address
    page.goto(address.replace("/record", "/compare?model=9999"))
    page.get_by_text("has no model 9999; the newest is shown").first.wait_for(state="attached")


def test_a_service_that_is_gone_is_asked_ever_more_seldom(open_page):
    page = open_page()
    page.locator(".badge.idle").wait_for()
    waits = page.evaluate(
        """async () => {
          const base = document.querySelector('script[type=module]').src;
          const { Live } = await import(base.replace('app/main', 'app/live'));
          const live = new Live();
          const waits = [];
          const real = window.setTimeout;
          window.fetch = () => Promise.reject(new TypeError('gone'));
          window.setTimeout = (act, wait_ms, ...more) => {
            if (wait_ms >= 1000) waits.push(wait_ms);
            return real(act, Math.min(wait_ms ?? 0, 5), ...more);
          };
          live.run();
          await new Promise((done) => real(done, 400));
          return waits.slice(0, 5);
        }"""
    )
    assert waits == [1000, 2000, 4000, 8000, 8000]


def test_hundreds_of_experiments_make_no_wall_of_boxes(open_page):
    one = {"kind": "steps", "source": "simulated", "outcome": "completed", "note": "", "tags": [], "parameters": {},
           "started_utc": "2026-01-01T00:00:00Z"}  # fmt: skip
    items = [{**one, "experiment_id": number} for number in range(1, 301)]
    page = open_page("#home")
    intercept(page, "**/api/v1/experiments?*", lambda route: route.fulfill(json={"items": items}))
    page.evaluate("location.hash = '#study'")
    page.get_by_text("280 more: find them by their words.").wait_for()
    assert page.locator("main :is(input, button, select, a)").count() < 60
    page.get_by_label("Find experiments").fill("299:")
    page.get_by_label("299: steps").check()
