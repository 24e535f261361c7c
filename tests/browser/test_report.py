"""The report of a study as whoever files it opens it: on a desk and on a phone, in light and dark, and printed."""

import re
from pathlib import Path

import pytest

from tests.service.recorded_joint import study_path

pytestmark = pytest.mark.browser
OUTSIDE = """() => [...document.querySelectorAll("td, th, figcaption, h1, h2, p, .main-svg")]
  .filter((one) => one.getBoundingClientRect().right > innerWidth + 1).map((one) => one.textContent.slice(0, 80))"""
NAMES = re.compile(r'(?<!")\b[a-z]+(?:_[a-z0-9]+)+\b(?!")')  # in quotes they are to be typed


@pytest.fixture(scope="module")
def report(service, tmp_path_factory) -> Path:
    path = study_path(service, "filed")
    service.client.post(f"{path}/models", json={"effect": "viscous_asymmetry"}).raise_for_status()
    file = Path(tmp_path_factory.mktemp("report") / "study.html")
    file.write_text(service.client.get(f"{path}/report", timeout=120).text, encoding="utf-8")
    return file


@pytest.fixture
def opened(chromium, report):
    page = chromium.new_page()
    faults = []
    page.on("pageerror", lambda error: faults.append(str(error)))

    def go(width: int, scheme: str = "light"):
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)
        page.goto(report.as_uri())
        page.locator(".figure .main-svg").first.wait_for()
        return page

    yield go
    page.close()
    assert faults == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1440, 390])
def test_nothing_stands_outside_the_screen_and_the_figures_can_be_read(opened, width, scheme):
    page = opened(width, scheme)
    assert page.evaluate(OUTSIDE) == []
    text = page.locator(".figure .xtick text").first.evaluate("(one) => getComputedStyle(one).fill")
    ground = page.evaluate("getComputedStyle(document.body).backgroundColor")
    light = [sum(map(int, re.findall(r"\d+", colour)[:3])) for colour in (text, ground)]
    assert (light[0] > light[1]) == (scheme == "dark")


def test_the_head_says_in_three_sentences_and_two_pictures_what_came_out(opened):
    page = opened(1440)
    parts = page.evaluate(
        """() => {
          const found = [];
          let one = document.querySelector("h2").nextElementSibling;
          for (; one.tagName !== "H2"; one = one.nextElementSibling) found.push(one.tagName);
          return found;
        }"""
    )
    assert parts.count("P") == 3
    assert parts.count("FIGURE") == 2
    for fact in ("date", "operator", "rig", "drive", "version", "commit"):
        page.locator("td", has_text=re.compile(f"^{fact}$")).first.wait_for()
    assert page.get_by_role("navigation", name="Contents").get_by_role("link").count() > 5


def test_no_name_for_programs_and_no_gain_of_minus_nothing(opened):
    page = opened(1440)
    page.evaluate(
        "[...document.querySelectorAll('caption')].find((one) => one.textContent === 'Rig').parentElement.remove()"
    )
    text = page.locator("body").inner_text()
    assert sorted(set(NAMES.findall(text))) == []
    assert not re.search(r"-0\.0+ ?%", text)
    assert not re.search(r"\d%", text)


def test_it_is_printed_in_dark_ink_and_without_frames_that_scroll(opened):
    page = opened(1440, "dark")
    page.emulate_media(media="print", color_scheme="dark")
    assert page.evaluate("getComputedStyle(document.body).color") == "rgb(0, 0, 0)"
    assert page.evaluate("getComputedStyle(document.querySelector('.table')).overflowX") == "visible"
