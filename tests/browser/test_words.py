"""Words, units and what is in reach: the same word for the same thing in every view, and a thumb's way to it."""

import re

import pytest

from tests.browser.browser import imported, intercept
from tests.service.recorded_joint import study_path

pytestmark = pytest.mark.browser
NOT_SAID = ("velocity", "degC", "µ", "0 held out", "It is held", "Surest in", "_rad", "_kg", "undefined", "NaN")
TEXT = """() => {
  const shown = document.querySelector("main").cloneNode(true);
  for (const one of shown.querySelectorAll("math, code, pre, .annotation, td[data-title=Name], select, label:has(input[type=checkbox])")) one.remove();
  return shown.textContent;
}"""  # noqa: E501
VIEWS = ("#home", "#bench", "#trials", "#study", "#study/{}/record", "#study/{}/compare", "#study/{}/result")
GO = """(hash) => location.hash === hash || new Promise((there) => {
  addEventListener("hashchange", () => setTimeout(() => there(true)), { once: true });
  location.hash = hash;
})"""
PHONE = {"width": 390, "height": 844}
THUMB_PX = 44  # what a finger hits, as the guidelines of both systems for phones have it


@pytest.fixture(scope="module")
def study(service) -> str:
    path = study_path(service, "worded")
    service.client.post(f"{path}/models", json={"effect": "viscous_asymmetry"}).raise_for_status()
    return path.split("/")[-1]


def test_one_thing_has_one_word_and_its_unit_is_written_as_people_write_it(open_page, study):
    page, said = open_page("#home", width=1440), []
    for view in VIEWS:
        page.evaluate(GO, view.format(study))
        page.locator("main :is(.panel, .door)").first.wait_for()
        for busy in page.locator("main .busy").all():
            busy.wait_for(state="detached")
        text = page.evaluate(TEXT)
        said += [(view, word) for word in NOT_SAID if word in text]
    assert said == []


def test_every_parameter_has_a_unit_or_is_a_number_and_an_interval(open_page, study):
    page = open_page(f"#study/{study}/result", width=1440)
    table = page.locator("[aria-label^='Parameters'] table").first
    table.wait_for()
    heads = table.locator("th").all_inner_texts()
    assert "Unit" in heads
    units = table.locator(f"tbody td:nth-child({heads.index('Unit') + 1})").all_inner_texts()
    assert [one for one in units if re.search(r"2|\bdeg\b", one)] == []
    assert sum(bool(one) for one in units) >= len(units) / 2
    assert "shape" not in units
    assert re.search(r"to|–", table.inner_text())


def test_a_reading_of_nothing_has_no_sign_and_noise_at_rest_is_not_drawn_as_motion(open_page):
    page = open_page()
    read = f"{imported('bench/liveplot')}.then((m) => [m.readingText(-1e-5, 'rad'), m.readingText(-0.5, 'A')])"
    assert page.evaluate(read) == ["0.00°", "−0.500 A"]
    words = "m.words({ position_rad: 0, current_a: -0.001 })"
    assert page.evaluate(f"{imported('joint/drawing')}.then((m) => {words})") == "0°  0.00 A"
    drawn = """{
      const height = (least) => {
        const canvas = Object.assign(document.createElement("canvas"), { width: 400, height: 300 });
        const context = canvas.getContext("2d", { willReadFrequently: true });
        const x = [0, 1, 2, 3], y = [1e-5, -1e-5, 1e-5, -1e-5];
        const theme = { text: "#fff", soft: "#fff", line: "#fff", font: "10px sans-serif" };
        m.paint(context, { width: 400, height: 300, view: [0, 3], theme, pointer: null,
          content: { rows: [{ title: "", least }], lines: [{ row: 0, x, y, colour: "#f00" }], xTitle: "" } });
        const { data } = context.getImageData(80, 0, 300, 300);
        const rows = new Set();
        for (let at = 0; at < data.length; at += 4) if (data[at] > 200 && data[at + 1] < 60 && data[at + 3] > 200) rows.add(Math.floor(at / 1200));
        return rows.size;
      };
      return [height(0), height(0.1)];
    }"""  # noqa: E501
    wild, calm = page.evaluate(f"{imported('plots/paint')}.then((m) => {drawn})")
    assert wild > 100
    assert calm <= 4


def test_the_title_of_an_axis_does_not_stand_over_its_numbers(open_page):
    page = open_page()
    drawn = """(range) => {
      const canvas = Object.assign(document.createElement("canvas"), { width: 500, height: 300 });
      const context = canvas.getContext("2d");
      const places = { title: [], numbers: [] };
      context.fillText = (text, x) => {
        if (context.textAlign === "right") places.numbers.push(x - context.measureText(text).width);
        else if (context.getTransform().b !== 0) places.title.push(context.getTransform().e + 8);
      };
      const theme = { text: "#000", soft: "#000", line: "#000", font: "12px system-ui, sans-serif" };
      m.paint(context, { width: 500, height: 300, view: [0, 1], theme, pointer: null,
        content: { rows: [{ title: "residual [N m]" }], lines: [{ row: 0, x: [0, 1], y: range, colour: "#f00" }], xTitle: "" } });
      return Math.min(...places.numbers) - Math.max(...places.title);
    }"""  # noqa: E501
    ranges = "[[-0.0015, 0.0015], [-0.02, 0.03], [-1200, 800], [99000, 250000]]"
    gaps = page.evaluate(f"{imported('plots/paint')}.then((m) => {ranges}.map({drawn}))")
    assert min(gaps) >= 0, gaps


def test_start_and_stop_are_in_reach_of_a_thumb(open_page):
    page = open_page("#bench", width=PHONE["width"])
    page.set_viewport_size(PHONE)
    start = page.get_by_role("button", name="Start", exact=True)
    start.wait_for()
    for button in (start, page.get_by_role("button", name="STOP")):
        box = button.bounding_box()
        assert box is not None
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= PHONE["height"]
        assert box["x"] + box["width"] <= PHONE["width"]
        assert box["height"] >= THUMB_PX - 8


def test_the_outcome_of_a_trial_and_what_a_challenge_hides_are_not_outside_a_phone(service, open_page):
    service.run("steps", repeats=1)
    page = open_page("#trials", width=PHONE["width"])
    outcome = page.locator("[aria-label='Trials'] tbody td[data-title=Outcome]").first
    outcome.wait_for()
    box = outcome.bounding_box()
    assert box["x"] >= 0
    assert box["x"] + box["width"] <= PHONE["width"]
    made = {"challenge_id": 1, "experiment_id": 1, "difficulty": "easy", "created_utc": "2026-01-01T00:00:00Z"}
    intercept(page, "**/api/v1/challenges", lambda route: route.fulfill(json={"items": [made]}))
    page.evaluate("location.hash = '#learn'")
    reveal = page.get_by_role("button", name="Guess at challenge 1")
    reveal.wait_for()
    box = reveal.bounding_box()
    assert box["x"] + box["width"] <= PHONE["width"]
