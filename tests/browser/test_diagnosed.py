"""What the page offers once a diagnosis is there: one thing to press, and that is what helps."""

import re

import pytest

from tests.browser.browser import intercept
from tests.service.recorded_joint import study_path

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def study(service) -> str:
    return study_path(service, "diagnosed").split("/")[-1]


@pytest.fixture
def diagnosed(open_page, study):
    """The page with a diagnosis of the study that was changed on its way."""

    def opened(**changes):
        page = open_page(f"#study/{study}/diagnose", width=1440)

        def change(route) -> None:
            answer = route.fetch()
            route.fulfill(response=answer, json={**answer.json(), **changes})

        intercept(page, "**/diagnose?*", change)
        page.get_by_role("button", name="Diagnose").click()
        page.locator(".diagnosed .sentence").wait_for()
        return page

    return opened


def primaries(page) -> list[str]:
    return page.locator(".diagnosed .primary").all_inner_texts()


def test_a_missing_effect_is_the_one_thing_to_add(diagnosed):
    page = diagnosed()
    page.locator("article").first.wait_for()
    assert primaries(page) == ["Add Direction-asymmetric viscous friction"]
    gain, low, high = re.search(
        r"gain (.+? %), 90 % interval (.+? %) to (.+? %)", page.inner_text(".diagnosed .sentence")
    ).groups()
    assert f"would fall by {gain} ({low} to {high})." in page.locator("article").first.inner_text()


def test_a_diagnosis_is_there_again_when_the_page_is_loaded_anew(diagnosed):
    page = diagnosed()
    page.reload()
    page.locator(".diagnosed .sentence").wait_for()
    page.goto(page.url.replace("/diagnose", "/compare"))
    page.reload()
    page.get_by_role("link", name="3 Diagnose").click()
    assert page.locator(".diagnosed .sentence").count() == 0, "nobody is kept waiting for what was not asked here"


def test_what_is_slight_is_no_candidate_and_the_result_is_next(diagnosed):
    page = diagnosed(slight=True, advice="Next to nothing is left: it would take 3.0% of the held-out error away.")
    page.get_by_text("Next to nothing is left: it would take 3.0 % of").wait_for()
    page.locator("article").first.wait_for()
    assert page.locator(".diagnosed .badge.completed").count() == 0
    assert primaries(page) == ["See the result"]
    page.get_by_role("button", name="See the result").click()
    page.wait_for_url("**/result")


def test_a_card_says_why_it_cannot_be_and_nothing_stands_outside_of_it(open_page, service, study):
    found = service.client.get(f"/studies/{study}/diagnose").json()
    first = found["ranking"][0]
    badges = ("known from the rig", "limit of the scan")
    ranking = [{**first, "effect": f"x{at}", "in_class": False, "physical": False, "badge": badge,
                "picture": {**first["picture"], "driver": "travel since the last reversal", "unit": "rad"}}
               for at, badge in enumerate(badges)]  # fmt: skip
    page = open_page(f"#study/{study}/diagnose", width=1300)
    intercept(page, "**/diagnose?*", lambda route: route.fulfill(json={**found, "classes": [], "ranking": ranking}))
    page.get_by_role("button", name="Diagnose").click()
    page.locator("article canvas").nth(1).wait_for()
    assert page.locator("article .badge").all_inner_texts() == list(badges)
    beyond = page.evaluate(
        "[...document.querySelectorAll('article')].flatMap((card) => { const right = (one) => "
        "one.getBoundingClientRect().right; return [...card.querySelectorAll('button, .legend, .legend-entry, .bar *')]"
        ".filter((one) => right(one) > right(card)).map((one) => one.textContent); })"
    )
    assert beyond == []
    crossing = page.evaluate(
        "[...document.querySelectorAll('article .legend')].filter((one) => one.scrollWidth > one.clientWidth).length"
    )
    assert crossing == 0


def test_a_provisional_curve_is_offered_and_not_pressed_on_anybody(diagnosed):
    picture = {"driver": "velocity", "unit": "rad/s", "against_motion": True, "x": [0, 1], "residual": [0, 1],
               "low": [0, 1], "high": [0, 1], "curve_x": [0, 1], "curve": [0, 1]}  # fmt: skip
    errors = {"held_out_before": 0.1, "held_out_after": 0.09, "gain": 0.1, "gain_low": 0.0, "gain_high": 0.2}
    curve = {"effect": "curve_of_velocity", "title": "Curve", "sentence": "Until then.", "picture": picture, **errors}
    page = diagnosed(verdict="unknown-effect", classes=[], ranking=[], provisional=curve)
    page.get_by_role("button", name="Add as a provisional term").wait_for()
    assert primaries(page) == []


def test_of_the_joint_of_a_challenge_one_is_told_what_was_hidden(open_page, service, diagnosed, study):
    trial = service.client.get(f"/studies/{study}").json()["trials"][0]["trial_id"]
    experiment = service.client.get(f"/trials/{trial}").json()["experiment_id"]
    made = {"items": [{"challenge_id": 7, "experiment_id": experiment, "difficulty": "easy", "created_utc": None}]}
    page = open_page("#home", width=1440)
    intercept(page, "**/api/v1/challenges", lambda route: route.fulfill(json=made))
    intercept(page, "**/diagnose?*", lambda route: _nothing(route))
    page.evaluate("(hash) => { location.hash = hash; }", f"#study/{study}/diagnose")
    page.get_by_role("button", name="Diagnose").click()
    page.get_by_role("link", name="Guess and reveal").click()
    page.get_by_text("What is hidden in challenge 7?").wait_for()


def _nothing(route) -> None:
    answer = route.fetch()
    route.fulfill(response=answer, json={**answer.json(), "verdict": "nothing", "classes": [], "ranking": []})
