"""Learning on the page: effects with their examples, and a challenge from its making to its answer."""

import re

import pytest

from bench.evaluation.challenge import difficulty
from bench.evaluation.challenge.difficulty import Difficulty
from tests.browser.browser import intercept
from tests.service.running_service import TOKEN

pytestmark = pytest.mark.browser
QUICK = Difficulty((0.0, 1.0, 0.0), (0.8, 1.0), 0.001, (1.0,), 2.0, 1, 1)


def test_an_effect_is_explained_and_its_example_answers_to_the_slider(open_page):
    page = open_page("#learn")
    page.get_by_label("Search").fill("grease wiped")
    page.get_by_role("link", name="Direction-asymmetric viscous friction").click()
    page.locator("math").wait_for()
    page.get_by_text("several speeds in both directions").wait_for()
    page.get_by_text("added by the effect").wait_for()
    points = "document.querySelector('.js-plotly-plot').data[0].y.map(Math.abs).reduce((a, b) => Math.max(a, b))"
    page.locator(".js-plotly-plot").wait_for()
    before = page.evaluate(points)
    page.get_by_label("How much of it").focus()
    page.keyboard.press("End")
    for _ in range(200):
        if page.evaluate(points) > before:
            break
        page.wait_for_timeout(50)
    assert page.evaluate(points) == pytest.approx(2 * before)


def test_a_challenge_is_made_guessed_at_and_revealed(open_page, monkeypatch):
    monkeypatch.setitem(difficulty.DIFFICULTIES, "easy", QUICK)
    page = open_page("#learn")
    page.set_default_timeout(60_000)
    page.get_by_role("button", name="New challenge").click()
    page.get_by_text("is ready. Make a study of experiment").wait_for()
    page.get_by_role("link", name="Study challenge").first.click()
    page.locator("fieldset input:checked").first.wait_for()
    page.get_by_role("link", name="Learn").click()
    page.get_by_role("button", name="Guess at challenge").first.click()
    assert page.get_by_label("or what a study").input_value() == ""  # none was made of it
    page.get_by_label("I say").select_option("nothing")
    page.get_by_role("button", name="Reveal").click()
    page.get_by_text("One mechanism was hidden").wait_for()
    assert page.locator("[aria-label='What was hidden'] tbody tr").count() == 1
    # what is drawn may be one that no recording of motion can tell: then nothing was missed, and that is said
    page.get_by_text(re.compile("^(Missed|Hidden, but no recording of motion can tell)")).first.wait_for()


def test_what_takes_long_is_cancelled_and_says_so(open_page):
    page = open_page("#learn")
    page.set_default_timeout(60_000)
    intercept(page, "**/api/v1/challenges", lambda route: None if route.request.method == "POST" else route.fallback())
    page.get_by_role("button", name="New challenge").click()
    page.get_by_role("progressbar", name="Drawing a joint").wait_for()
    page.get_by_text("s left").wait_for()
    page.get_by_role("button", name="Cancel").click()
    page.get_by_text("Cancelled: nothing of it is kept.").wait_for()
    assert page.get_by_role("button", name="New challenge").is_enabled()


def test_what_lacks_a_token_goes_on_once_there_is_one(open_page):
    page = open_page("#learn", token=False)
    posts = []

    def answer(route) -> None:
        if route.request.method != "POST":
            route.fallback()
            return
        posts.append(route.request.headers.get("authorization"))
        if len(posts) == 1:
            route.fulfill(status=401, json={"detail": "send 'Authorization: Bearer <token>'"})

    intercept(page, "**/api/v1/challenges", answer)
    page.get_by_role("button", name="New challenge").click()
    page.get_by_text("This needs the token").wait_for()
    page.get_by_label("Token: to start").fill(TOKEN)
    page.get_by_role("button", name="Use token").click()
    page.get_by_role("progressbar", name="Drawing a joint").wait_for()
    assert posts == [None, f"Bearer {TOKEN}"]
    open_page.expected.append("401")


def test_the_dots_of_a_derivative_stand_above_its_letter(open_page):
    page = open_page("#learn")
    page.locator("article mover").first.wait_for()
    letter, dots = (
        page.locator("article mover").first.locator(f":scope > {one}").bounding_box() for one in ("mi", "mo")
    )
    assert dots["y"] + dots["height"] + 1 < letter["y"]
