"""Trials on the page: found, laid over each other, looked at closely."""

import re

import pytest

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def experiment(service) -> int:
    return service.run("load-sweep", loads_kg=[0.0, 0.1], repeats=1)["experiment_id"]


def test_trials_are_found_laid_over_each_other_and_read_closer(service, open_page, experiment):
    page = open_page("#trials")
    page.get_by_role("button", name=f"Trials of experiment {experiment}", exact=True).click()
    page.get_by_label("Search").fill("load 0.1 kg 1.571")
    page.get_by_text(re.compile(r"^1 of \d+ trials")).wait_for()
    page.get_by_label("Search").fill("1.571")
    page.get_by_text(re.compile(r"^2 of \d+ trials")).wait_for()
    for box in page.get_by_label(re.compile("Choose trial")).all():
        box.check()
    page.get_by_role("button", name="Lay the chosen over each other").click()
    group = page.get_by_role("group", name="Channels of trial")
    group.locator(".legend-entry").nth(5).wait_for()
    with page.expect_request(re.compile("samples.*from_s=")) as asked:
        for _ in range(3):
            group.get_by_role("button", name="Zoom in").click()
    assert asked.value.response().status == 200
    group.get_by_role("img").hover()
    group.get_by_text(re.compile("position −?[0-9.]+, ")).wait_for()
    group.page.get_by_role("combobox", name="over").select_option("position_rad")
    page.locator("[aria-label='One channel against another'] .trace").first.wait_for()
    page.locator("[aria-label^='Load sweep'] .trace").first.wait_for()


FRAME = "() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))"


def test_a_chart_is_moved_by_the_keyboard_and_shows_the_load_with_its_band(open_page, experiment):
    page = open_page("#trials")
    page.get_by_role("button", name=f"Trials of experiment {experiment}", exact=True).click()
    page.get_by_role("button", name="Plot trial").first.click()
    page.get_by_role("group", name="Channels of trial").get_by_text("load (band: 95 %)").wait_for()
    chart = page.get_by_role("group", name="Channels of trial").get_by_role("img")
    chart.focus()
    before = chart.screenshot()
    page.keyboard.press("+")
    page.evaluate(FRAME)
    closer = chart.screenshot()
    assert closer != before
    page.keyboard.press("ArrowRight")
    page.evaluate(FRAME)
    assert chart.screenshot() != closer
