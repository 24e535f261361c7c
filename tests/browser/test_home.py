"""The first page: few words, few controls, the joint, and three ways in."""

import re

import pytest

pytestmark = pytest.mark.browser
CONTROLS = "a, button, input, select, textarea, summary, [tabindex='0']"
SHOWN = f"""() => [...document.querySelectorAll("{CONTROLS}")].filter((one) => one.checkVisibility()).length"""
WORDS = "document.body.innerText.trim().split(/\\s+/).length"


@pytest.mark.parametrize("token", [True, False])
@pytest.mark.parametrize("width", [1440, 390])
def test_the_first_page_has_few_controls_and_few_words(open_page, width, token):
    page = open_page("", width=width, token=token)
    page.locator(".badge.idle").wait_for()
    page.get_by_role("link", name="Find a hidden effect").wait_for()
    assert page.evaluate(SHOWN) <= 12
    assert page.evaluate(WORDS) <= 80


def test_it_is_painted_within_a_second_and_sends_little(open_page):
    page = open_page("")
    page.locator(".door").first.wait_for()
    page.wait_for_function("performance.getEntriesByName('first-contentful-paint').length > 0")
    first_paint, answered, sent = page.evaluate(
        """() => [performance.getEntriesByName("first-contentful-paint")[0].startTime,
          performance.getEntriesByType("navigation")[0].responseEnd,
          performance.getEntries().reduce((sum, one) => sum + (one.transferSize ?? 0), 0)]"""
    )
    assert first_paint - answered < 1000
    assert sent < 700_000


def test_each_door_leads_to_where_it_says(open_page):
    page = open_page("")
    page.get_by_role("link", name="Watch a run").click()
    page.get_by_text("Start moves the simulated joint between 0° and 90°").wait_for()
    assert page.get_by_label("repeats").input_value() == "2"
    page.go_back()
    page.get_by_role("link", name="Find a hidden effect").click()
    page.get_by_role("button", name="New challenge").wait_for()
    page.go_back()
    page.get_by_role("link", name="Bring my own recording").click()
    page.get_by_label("Recording set (.zip)").wait_for()


def test_the_joint_is_seen_to_move_and_to_stand_again(service, open_page):
    page = open_page("")
    joint = page.get_by_role("img", name="The joint from the side")
    joint.wait_for()
    service.start("steps", pace="real-time", repeats=3)
    angles = set()
    for _ in range(60):
        found = re.search(r"(−?[\d.]+)°", joint.get_attribute("aria-label") or "")
        angles.add(found[1] if found else "")
        if len(angles) > 5:
            break
        page.wait_for_timeout(100)
    assert len(angles) > 5, angles
    page.keyboard.press("Escape")
    page.locator("svg.joint.dimmed").wait_for()
