"""Commissioning on the page: one step a screen, what moves and how far, STOP, and the files at the end."""

import tomllib

import pytest

from tests.browser.commissioned import answer, walked

pytestmark = pytest.mark.browser


def test_each_step_says_what_moves_and_the_last_hands_over_both_files(commissioning, open_page):
    page = open_page("#commission", service=commissioning)
    seen = {}
    for key in walked(page):
        seen[key] = page.locator("main").inner_text()
        assert page.get_by_role("button", name="STOP").is_visible()
    assert list(seen) == [
        "arm_length_m", "gear_ratio", "counts_per_turn", "motor_current_a", "load_kg", "down", "hand_angle_deg",
        "clear", "first_load_kg", "end",
    ]  # fmt: skip
    assert "Nothing is powered" in seen["hand_angle_deg"]
    assert "The arm stays within −52° to 52°." in seen["clear"]
    assert "0.58 to 0.64" not in seen["clear"]
    assert "0.58 to 0.64" in seen["first_load_kg"]  # found by the pushes, with its interval
    assert "The trial load of 50 g was found as 50.3 g." in seen["end"]
    files = {}
    for name in ("bench.toml", "the evidence"):
        with page.expect_download() as told:
            page.get_by_role("button", name=f"Download {name}").click()
        files[told.value.suggested_filename] = told.value.path().read_text()
    assert tomllib.loads(files["bench.toml"])["rig"]
    assert '"high": 0.64' in files["bench.evidence.json"]


def test_the_drawing_shows_where_the_hand_and_the_motor_bring_the_arm(commissioning, open_page):
    page = open_page("#commission", service=commissioning)
    arc, target = page.locator(".step-joint .joint-range"), page.locator(".step-joint .joint-target")
    for key in walked(page):
        if key == "hand_angle_deg":
            page.wait_for_function("!document.querySelector('.step-joint .joint-target').matches('.hidden')")
            assert target.get_attribute("transform") == "rotate(-90)"
        if key == "clear":
            pushed = arc.get_attribute("d")
        if key == "first_load_kg":
            assert arc.get_attribute("d") != pushed


def test_a_value_out_of_bounds_is_said_at_the_field_and_sent_nowhere(commissioning, open_page):
    page = open_page("#commission", service=commissioning)
    page.get_by_role("button", name="Begin").click()
    page.locator("[data-question=arm_length_m]").wait_for()
    for typed, said in (("7", "0.02 to 3 m"), ("", "A number is missing."), ("long", "'long' is no number.")):
        page.locator("#answer").fill(typed)
        page.get_by_role("button", name="Answer").click()
        page.get_by_role("alert").filter(has_text=said).wait_for()
    page.wait_for_timeout(600)
    assert page.locator("#answer").input_value() == "long"  # the page asks anew all the time: what is typed stays
    assert commissioning.client.get("/commission").json()["question"]["key"] == "arm_length_m"


def test_escape_ends_it_and_the_page_says_why(commissioning, open_page):
    page = open_page("#commission", service=commissioning)
    page.get_by_role("button", name="Begin").click()
    page.locator("[data-question=arm_length_m]").wait_for()
    answer(page, "arm_length_m")
    page.locator("[data-question=gear_ratio]").wait_for()
    page.keyboard.press("Escape")
    page.get_by_text("Not commissioned: STOP on the page").wait_for()
    assert commissioning.client.get("/commission").json()["state"] == "refused"
    page.get_by_role("button", name="Begin anew").click()
    page.locator("[data-question=arm_length_m]").wait_for()
    assert page.locator("#answer").input_value() == "0.25"  # as it was typed before


def test_a_simulated_bench_says_what_it_takes(open_page):
    page = open_page("#bench")
    page.get_by_role("link", name="Commission a joint of your own").click()
    page.get_by_text("friction-bench serve --drive drive.toml").wait_for()
    assert page.get_by_role("button", name="Begin").count() == 0
