"""No view breaks a rule of axe-core: names, roles, contrast, order; light and dark, wide and narrow."""

import pytest

from tests.browser.commissioned import walked
from tests.service.recorded_joint import recording_set_zip

pytestmark = pytest.mark.browser
VIEWS = ("#home", "#bench", "#commission", "#queue", "#trials", "#study", "#learn", "#learn/backlash")
OF_COLOUR = ["color-contrast", "link-in-text-block"]
WIDE_PX, NARROW_PX = 1440, 390


@pytest.fixture(scope="module")
def axe():
    return pytest.importorskip("axe_playwright_python.sync_playwright", reason="axe-playwright-python missing").Axe()


@pytest.fixture(scope="module")
def study(service) -> str:
    """A study to look at, and a trial."""
    service.run("steps", repeats=1)
    headers = {"Content-Type": "application/zip"}
    made = service.client.post("/recording-sets?name=read+aloud", content=recording_set_zip(), headers=headers).json()
    body = {"name": "read aloud", "experiment_ids": [made["experiment_id"]], "hold_out": ["amplitude_rad=0.9"]}
    return f"#study/{service.client.post('/studies', json=body).json()['study_id']}"


def violations(axe, page) -> list[str]:
    """What breaks a rule in the light; in the dark only colours differ, and no colour hangs on the width."""
    found = ruled_out(axe, page)
    if page.viewport_size["width"] == WIDE_PX:
        page.emulate_media(color_scheme="dark")
        found += ruled_out(axe, page, runOnly=OF_COLOUR)
        page.emulate_media(color_scheme="light")
    return found


def ruled_out(axe, page, **options) -> list[str]:
    if not page.evaluate("'axe' in window"):
        page.evaluate(axe.axe_script)
    run = "(options) => axe.run(options).then(({ violations }) => violations)"
    found = page.evaluate(run, {"resultTypes": ["violations"], **options})
    return [f"{one['id']}: {node['html'][:160]} {node['failureSummary']}" for one in found for node in one["nodes"]]


def steps_broken(axe, page) -> list[str]:
    """What is wrong in the steps of a study, each with its details open."""
    broken = []
    page.locator("table.heat button.cell").first.wait_for()
    for step in ("1 Record", "2 Compare", "3 Diagnose", "4 Add", "5 Result"):
        page.get_by_role("link", name=step).click()
        if step == "2 Compare":
            page.get_by_text("Residual against what drives it").click()
            page.locator("canvas[aria-label^='Residual against']").first.wait_for()
            page.get_by_text("In closed loop", exact=True).click()
            page.get_by_role("button", name="Simulate", exact=True).click()
            page.get_by_role("group", name="In closed loop").locator("canvas.chart").first.wait_for()
        if step == "3 Diagnose":
            page.get_by_role("button", name="Diagnose").click()
            page.locator("article canvas.chart").first.wait_for()
        broken += [f"{step} {one}" for one in violations(axe, page)]
    return broken


@pytest.mark.parametrize("width", [WIDE_PX, NARROW_PX])
def test_no_view_breaks_a_rule(axe, open_page, study, width):
    page = open_page("#bench", width=width)
    page.locator(".badge.idle").wait_for()
    broken = []
    for view in (*VIEWS, study):
        page.evaluate("(hash) => { location.hash = hash; }", view)
        page.locator("main :is(.panel, .door)").first.wait_for()
        for busy in page.locator("main .busy").all():
            busy.wait_for(state="detached")
        if view == "#queue":
            page.get_by_label("Values of parameter 1").fill("0, 0.1")
            page.get_by_role("button", name="Plan", exact=True).click()
            page.locator("[aria-label='Plan of the campaign']").wait_for()
        if view == "#trials":
            page.get_by_role("button", name="Edit note and tags").first.click()
            page.get_by_role("button", name="Plot trial").first.click()
            page.get_by_role("group", name="Channels of trial").locator(".legend-entry").first.wait_for()
        if view == study:
            broken += steps_broken(axe, page)
        else:
            broken += [f"{view} {one}" for one in violations(axe, page)]
    assert broken == []


@pytest.mark.parametrize("width", [WIDE_PX, NARROW_PX])
def test_no_step_of_commissioning_breaks_a_rule(axe, commissioning, open_page, width):
    page = open_page("#commission", width=width, service=commissioning)
    broken = [f"before {one}" for one in violations(axe, page)]
    for key in walked(page):
        broken += [f"{key} {one}" for one in violations(axe, page)]
    assert broken == []


def test_a_broken_rule_is_found(axe, open_page):
    """The check itself: it does see what is wrong, also what is wrong in the dark alone."""
    page = open_page(width=WIDE_PX)
    page.locator(".badge.idle").wait_for()
    page.evaluate("document.body.append(document.createElement('input'))")  # a view may be drawn anew, with all in it
    page.evaluate("document.body.appendChild(document.createElement('p')).append('pale')")
    page.evaluate("document.querySelector('body > p').style.background = 'white'")  # by hand: the policy forbids a text
    in_the_light, found = ({one.split(":")[0] for one in ask(axe, page)} for ask in (ruled_out, violations))
    assert "label" in in_the_light
    assert found - in_the_light == {"color-contrast"}
