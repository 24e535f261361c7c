"""The guided tour: followed by pressing what it points at, from its link to its end; it does the real thing."""

import time

import pytest

from bench.service.routes import challenges
from tests.service.running_service import TOKEN

pytestmark = pytest.mark.browser
SEED = 13  # of the challenge; see test_walk.py
STEPS = 12
MOST_S, MOST_CLICKS = 300, 20
DESK, PHONE = {"width": 1440, "height": 900}, {"width": 390, "height": 844}


# in one go, as the tour may go on between two looks: the target of this step that was not pressed yet
MARK = """(step) => {
  const target = document.querySelector(".tour-target");
  const shown = document.querySelector(".tour .soft")?.textContent.startsWith(`${step} of `);
  if (!shown || !target || target.dataset.pressed === String(step)) return false;
  target.dataset.pressed = String(step);
  return true;
}"""


@pytest.mark.timeout(600)
def test_the_tour_leads_to_an_explained_effect_by_what_it_points_at(open_page, monkeypatch, tmp_path):
    """On a phone first, where each target has to be in reach, too, then on a desk, where it is pressed."""
    monkeypatch.setattr(challenges.secrets, "randbits", lambda _bits: SEED)
    page = open_page("#home", token=False, width=DESK["width"])
    page.set_default_timeout(120_000)
    begun_s = time.monotonic()
    page.get_by_role("link", name="Guided tour").click()
    tour = page.get_by_role("region", name="Guided tour")
    pressed = []
    for step in range(1, STEPS):
        tour.get_by_text(f"{step} of {STEPS}").wait_for()
        while tour.get_by_text(f"{step} of {STEPS}").count():
            if not page.evaluate(MARK, step):
                page.wait_for_timeout(100)
                continue
            target = page.locator(f".tour-target[data-pressed='{step}']")
            for size in (PHONE, DESK):
                page.set_viewport_size(size)
                target.click(trial=True, timeout=10_000)
                page.screenshot(path=tmp_path / f"{size['width']}-{step:02d}-{len(pressed):02d}.png")
            if step == 1:
                target.fill(TOKEN)
                page.keyboard.press("Enter")
            else:
                target.click(timeout=10_000)
            pressed.append(step)
    page.get_by_text("One mechanism was hidden, and the guess says just that.").wait_for()
    tour.get_by_role("button", name="Done").click()
    tour.wait_for(state="detached")
    assert time.monotonic() - begun_s < MOST_S
    assert len(pressed) + 2 <= MOST_CLICKS, pressed  # and the link of the tour, and Done


def test_the_tour_is_left_and_taken_up_again_where_it_was(open_page):
    page = open_page("#tour")
    tour = page.get_by_role("region", name="Guided tour")
    tour.get_by_text(f"2 of {STEPS}").wait_for()  # there is a token already
    page.reload()
    tour.get_by_text(f"2 of {STEPS}").wait_for()
    tour.get_by_role("button", name="End the tour").click()
    tour.wait_for(state="detached")
    assert page.locator(".tour-target").count() == 0
