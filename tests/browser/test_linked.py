"""Plots of a study that are read together: one cursor, and the moments behind a cell or a candidate."""

import json
import re

import pytest

from tests.browser.browser import imported, intercept
from tests.service.recorded_joint import study_path

pytestmark = pytest.mark.browser
LEFT_PX = 78  # of the axis, in paint.js
# a request that is never answered, and never sent: one that a test lets go of would reach the service after all
HELD = """(ending) => {
  const { fetch } = window;
  window.fetch = (url, options) => !url.split("?")[0].endsWith(ending) ? fetch(url, options)
    : new Promise((_, reject) => options.signal.addEventListener("abort", () => reject(options.signal.reason)));
}"""


@pytest.fixture(scope="module")
def study(service) -> str:
    return study_path(service, "linked").split("/")[-1]


@pytest.fixture
def page(open_page, study):
    opened = open_page(f"#study/{study}/compare", width=1440)
    opened.locator("table.heat button.cell").first.wait_for()
    return opened


def plots(page):
    return page.get_by_label("Measured against predicted", exact=True)


def point(canvas, share: float) -> None:
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    canvas.hover(position={"x": LEFT_PX + share * (box["width"] - LEFT_PX - 10), "y": box["height"] / 3})


def test_a_cursor_in_one_plot_stands_in_all_of_them(page):
    page.get_by_text("Residual against what drives it").click()
    speed = page.locator(".chart-box", has=page.locator("canvas[aria-label^='Residual against speed']")).first
    speed.wait_for()
    point(plots(page).locator("canvas"), 0.4)
    plots(page).locator(".values").get_by_text("measured").wait_for()
    speed.locator(".values").get_by_text(re.compile(r"^−?-?\d.*: ")).wait_for()
    page.locator("table.heat td.here").wait_for()
    first = speed.locator(".values").inner_text()
    point(plots(page).locator("canvas"), 0.43)
    page.wait_for_function("([a, b]) => a.textContent !== b", arg=[speed.locator(".values").element_handle(), first])


def test_a_cell_shows_its_worst_moment_at_once(page):
    before = plots(page).locator("canvas").screenshot()
    page.locator("table.heat button.cell.worst").click()
    page.get_by_role("region", name="Moments").wait_for()
    first = page.locator("[aria-label='Moments'] tbody tr").first.locator("td").first.inner_text()
    assert plots(page).get_by_label("Trial").evaluate("(one) => one.selectedOptions[0].textContent") == first
    page.wait_for_timeout(300)
    assert plots(page).locator("canvas").screenshot() != before
    assert page.evaluate("document.activeElement.className").startswith("cell")  # whoever goes through cells goes on


def test_a_candidate_shows_where_it_acts_and_what_it_would_take_away(page):
    page.get_by_role("link", name="3 Diagnose").click()
    page.get_by_role("button", name="Diagnose").click()
    first = page.locator("article", has_text="candidate").first
    first.get_by_role("button", name=re.compile("Show where .* acts")).click()
    plots(page).get_by_text("predicted with the effect").wait_for()
    plots(page).get_by_text("predicted by the model").wait_for()
    moments = first.locator("[aria-label='Moments'] tbody tr")
    rms, with_it = (float(moments.first.locator("td").nth(at).inner_text()) for at in (3, 4))
    assert with_it < rms
    plots(page).get_by_role("button", name="The model alone").click()
    plots(page).get_by_text("predicted by the model").wait_for(state="detached")


def test_stretches_of_time_are_found_where_something_is_true(page):
    call = f"{imported('studies/linked')}.then((m) => m.stretches([0, 1, 2, 3, 4], [true, true, false, false, true]))"
    assert page.evaluate(call) == [{"from": 0, "to": 1}, {"from": 4, "to": 4}]


@pytest.mark.parametrize(
    ("step", "button", "asked"),
    [
        ("3 Diagnose", "Diagnose", "/diagnose"),
        ("4 Add", "Search by itself", "/search"),
        ("2 Compare", "Simulate", "/closed-loop"),
        ("2 Compare", "Report of study .*", "/report"),
    ],
)
def test_what_takes_long_says_what_it_does_and_how_much_is_left_and_is_cancelled(page, step, button, asked):
    told = {"job": "b", "what": "any", "state": "computing", "stage": "Judging the measuring chain", "share": 0.6,
            "stages_done": 4, "stages": 8, "passed_s": 3.0, "left_s": 2.0}  # fmt: skip
    body = f"event: progress\ndata: {json.dumps(told)}\n\n"
    intercept(page, "**/live/jobs/*/stream", lambda route: route.fulfill(content_type="text/event-stream", body=body))
    page.evaluate(HELD, asked)
    page.get_by_role("link", name=step).click()
    if button == "Simulate":
        page.locator("summary", has_text="In closed loop").click()
    page.get_by_role("button", name=re.compile(f"^{button}$")).click()
    page.get_by_text(re.compile(r"Judging the measuring chain, 5 of 8\. \d+ s, about 2 s left")).wait_for()
    assert page.get_by_role("progressbar").evaluate("(bar) => bar.value") == pytest.approx(0.6)
    page.get_by_role("button", name="Cancel").click()
    page.get_by_text("Cancelled: nothing of it is kept.").wait_for()


def test_the_progress_of_a_diagnosis_comes_from_the_lab(page):
    page.evaluate(
        """() => {
          window.told = new Set();
          new MutationObserver(() => {
            const words = document.querySelector(".diagnosed .waiting span")?.textContent ?? "";
            if (/, \\d of 8\\./.test(words)) window.told.add(words.split(",")[0]);
          }).observe(document.body, { subtree: true, childList: true, characterData: true });
        }"""
    )
    page.get_by_role("link", name="3 Diagnose").click()
    page.get_by_role("button", name="Diagnose").click()
    page.locator(".diagnosed .sentence").wait_for()
    # the diagnosis of this study may be known already, and then tells nothing: another model of it is not
    page.locator("article", has_text="candidate").first.get_by_role("button", name="Add").click()
    page.get_by_role("button", name="Undo this change").wait_for()
    page.get_by_role("link", name="3 Diagnose").click()
    page.locator("#diagnose-now").click()
    page.locator(".diagnosed .sentence").wait_for()
    assert page.evaluate("[...window.told]")
