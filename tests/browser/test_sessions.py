"""Sessions as a strip of days, presets, and the big numbers beside the bench."""

import re
from datetime import UTC, datetime, timedelta

import pytest

from bench.store.tables import experiments

pytestmark = pytest.mark.browser


@pytest.fixture(scope="module")
def two_days(service) -> list[str]:
    """Trials of two days; one of the later ones was tripped."""
    found = []
    with pytest.MonkeyPatch.context() as patched:
        for begun in (datetime(2026, 2, 3, 12, tzinfo=UTC) + timedelta(days=number) for number in range(2)):
            patched.setattr(experiments, "now", lambda begun=begun: begun)
            experiment = service.store.begin_experiment("steps", {}, "simulated", {}, {"name": "paper"})
            for number in range(3):
                name = f"{begun.date()}-{number}"
                writer = service.store.begin_trial(experiment, name, "steps", {}, ["time_s"])
                writer.finish("tripped" if begun.day == 4 and number == 2 else "completed", "", {})
            service.store.finish_experiment(experiment, "completed", "", {})
            found.append(str(begun.date()))
    return found


def test_a_day_of_the_strip_shows_its_trials_and_is_kept_as_a_preset(two_days, open_page):
    page = open_page("#trials", width=1440)
    page.get_by_role("button", name=f"{two_days[1]}: 3 trials, 1 not completed").click()
    page.get_by_text("1 to 3 of 3 trials").wait_for()
    assert f"day={two_days[1]}" in page.url
    page.get_by_text("Presets").click()
    page.get_by_label("Name of the preset").fill("the day of the trip")
    page.get_by_role("button", name="Save as preset").click()
    page.get_by_role("button", name=f"{two_days[1]}: 3 trials").click()  # all days again
    page.get_by_text("Choose one to see its trials.").wait_for()
    page.locator("#trials-preset").select_option("the day of the trip")
    page.get_by_text("1 to 3 of 3 trials").wait_for()
    page.reload()
    page.get_by_text(f"Trials of {two_days[1]}.").wait_for()


def test_parameters_of_an_experiment_are_kept_as_a_preset(open_page):
    page = open_page("#bench")
    page.get_by_label("repeats").fill("7")
    page.get_by_text("Presets").click()
    page.get_by_label("Name of the preset").fill("seven")
    page.get_by_role("button", name="Save as preset").click()
    page.get_by_label("repeats").fill("2")
    page.locator("#bench-preset").select_option("seven")
    page.locator("#view").get_by_label("repeats").wait_for()
    page.wait_for_function("document.querySelector('#parameter-repeats')?.value === '7'")
    page.get_by_text("7 trials").wait_for()


def test_big_numbers_follow_the_joint_and_stop_it(service, open_page):
    page = open_page("#numbers", width=1024)
    service.start("steps", pace="real-time", repeats=50)
    page.get_by_text(re.compile(r"^steps, trial \d+ of 50$")).wait_for()
    angle = page.locator(".numbers-values dd").first
    seen = set()
    for _ in range(60):
        seen.add(angle.inner_text())
        if len(seen) > 3:
            break
        page.wait_for_timeout(100)
    assert len(seen) > 3, seen
    page.locator("button.numbers-stop").click()
    page.get_by_text("The drive is off: steps stopped").wait_for()
    page.locator(".dimmed .numbers-values").wait_for()
