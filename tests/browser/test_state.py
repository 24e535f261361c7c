"""What the page says of the bench is true now: one state behind badge, message and readings."""

import json
import re
import time

import pytest

from bench.runs.runner import Runner
from tests.browser.browser import imported, intercept
from tests.service.running_service import TOKEN

pytestmark = pytest.mark.browser
RUNNING = {"state": "running", "run": {"experiment_id": 2, "power_off": None}}
STOPPED = {"state": "idle", "run": {"experiment_id": 1, "power_off": "confirmed"}}
POWERED = {"state": "idle", "run": {"experiment_id": 1, "power_off": "failed"}}

SETTLED = """() => new Promise((done) => {
  let [at, since_ms] = [scrollY, performance.now()];
  const look = () => {
    if (scrollY !== at) [at, since_ms] = [scrollY, performance.now()];
    if (performance.now() - since_ms > 500) done();
    else requestAnimationFrame(look);
  };
  look();
})"""  # once the page has not scrolled for half a second
LAST_CYCLE = (
    r"^The drive is off\. These are the readings of the last cycle before that, {}; since then nothing is measured\."
)


def start(page) -> None:
    page.get_by_role("button", name="Start", exact=True).click()
    page.locator(".badge.running").wait_for()


@pytest.mark.parametrize(
    ("phase", "status", "heard_ms", "said"),
    [
        ("confirmed", STOPPED, 1100, True),
        ("confirmed", RUNNING, 1100, False),  # another experiment has begun
        ("confirmed", STOPPED, 20_000, False),  # long ago
        ("unconfirmed", STOPPED, 900, True),  # heard before STOP was pressed: tells nothing of it
        ("unconfirmed", STOPPED, 1100, False),
        ("unconfirmed", POWERED, 1100, True),
        ("unconfirmed", {**RUNNING, "run": {"experiment_id": 1}}, 1100, True),
        ("no-token", STOPPED, 1100, False),
        ("asking", STOPPED, 1100, True),
    ],
)
def test_a_message_about_a_stop_stands_as_long_as_it_is_true(open_page, phase, status, heard_ms, said):
    stop = {"phase": phase, "text": "…", "experiment_id": 1, "at_ms": 1000}
    facts = {"status": status, "fresh": True, "heard_ms": heard_ms, "now_ms": heard_ms + 10}
    call = f"{imported('app/state')}.then((m) => m.messageOf({json.dumps(stop)}, {json.dumps(facts)}) !== null)"
    assert open_page().evaluate(call) is said


@pytest.mark.parametrize("opening_s", [0.0, 0.6])  # a drive that opens slowly: STOP comes before the run has a number
def test_powered_off_is_not_said_of_a_joint_that_runs_again(service, open_page, monkeypatch, opening_s):
    begin = Runner._begin
    monkeypatch.setattr(Runner, "_begin", lambda *args: (time.sleep(opening_s), begin(*args))[1])
    page = open_page("#bench?kind=steps&repeats=20")
    start(page)
    page.keyboard.press("Escape")
    said = page.locator("#stop-answer").get_by_text("the drive is powered off")
    said.wait_for()
    page.locator(".badge.idle").wait_for()
    service.runner.wait(10.0)  # its record is closed a moment before its thread has ended
    start(page)
    said.wait_for(state="detached", timeout=4000)  # by itself it would go after ten seconds
    page.keyboard.press("Escape")
    page.locator(".badge.idle").wait_for()


def test_not_confirmed_is_taken_back_when_the_joint_has_come_to_rest(service, open_page):
    page = open_page("#bench?kind=steps&repeats=20")
    start(page)
    intercept(page, "**/api/v1/stop", lambda route: route.abort())
    page.keyboard.press("Escape")
    page.get_by_text("Stop NOT confirmed").wait_for()
    service.client.post("/stop").raise_for_status()
    page.locator(".badge.idle").wait_for()
    page.locator("#stop-answer").get_by_text("NOT confirmed").wait_for(state="detached", timeout=10_000)
    open_page.expected.append("ERR_FAILED")


def test_old_readings_are_dimmed_and_say_how_old_they_are(service, open_page):
    page = open_page("#bench?kind=steps&repeats=20")
    start(page)
    readings = page.locator(".readings:not(.dimmed)")
    readings.get_by_text("position").wait_for()
    page.keyboard.press("Escape")
    page.locator(".readings.dimmed").get_by_text("position").wait_for()
    page.get_by_text(re.compile(LAST_CYCLE.format(r"\d+ s ago"))).wait_for()
    for name in ("last speed", "last current from duty", "last duty"):
        page.locator(".readings.dimmed dt").get_by_text(name, exact=True).wait_for()
    assert service.client.get("/bench").json()["reading"]["power"] == "disabled"
    late = open_page()
    late.get_by_text(re.compile(LAST_CYCLE.format(".* ago"))).wait_for()
    late.locator(".readings dt").get_by_text("last speed", exact=True).wait_for()
    service.runner.wait(10.0)  # its record is closed a moment before its thread has ended
    start(late)
    late.locator(".readings:not(.dimmed) dt").get_by_text("speed", exact=True).wait_for()
    late.keyboard.press("Escape")
    late.locator(".badge.idle").wait_for()
    service.runner.wait(10.0)


def test_stop_without_a_token_says_what_to_do_in_plain_words(service, open_page):
    service.start("steps", pace="real-time", repeats=20)
    page = open_page(token=False)
    page.locator(".badge.running").wait_for()
    page.keyboard.press("Escape")
    answer = page.locator("#stop-answer")
    answer.get_by_text("Not stopped: this page has no token yet. Paste the token").wait_for()
    assert "Authorization" not in answer.inner_text()
    page.get_by_label("Token: to start").fill(TOKEN)
    page.get_by_role("button", name="Use token").click()
    answer.get_by_text("the drive is powered off").wait_for()
    assert service.runner.status().outcome == "stopped"
    open_page.expected.append("401")


def test_enter_in_a_field_moves_nothing(service, open_page):
    page = open_page("#bench?kind=steps&repeats=2")
    before = len(service.client.get("/experiments").json()["items"])
    for label in ("repeats", "load [g]", "angle [°]"):
        page.get_by_label(label).press("Enter")
    page.get_by_text("Start moves the simulated joint between 0° and 90°").wait_for()
    page.wait_for_timeout(700)
    assert len(service.client.get("/experiments").json()["items"]) == before
    page.goto(page.url.replace("#bench?kind=steps&repeats=2", "#queue"))
    page.get_by_label("Name").press("Enter")
    page.wait_for_timeout(700)
    assert service.client.get("/queue").json()["waiting"] == []


def test_a_typing_error_is_marked_before_anything_is_sent_and_leaves_no_record(service, open_page):
    page = open_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url) if request.method == "POST" else None)
    page.get_by_label("repeats").fill("many")
    page.get_by_text("'many' is no number.").wait_for()
    page.get_by_label("load [g]").fill("-1")
    page.get_by_text("−1 g is not allowed. At least 0 g.").wait_for()
    assert page.locator("[aria-invalid=true]").count() == 2
    before = service.client.get("/experiments").json()["items"]
    asked.clear()
    page.get_by_role("button", name="Start", exact=True).click()
    page.get_by_text("nothing has moved, nothing is recorded").wait_for()
    assert asked == []
    assert service.client.get("/experiments").json()["items"] == before


def test_a_limit_of_the_bench_is_marked_at_its_field(service, open_page):
    page = open_page()
    page.get_by_label("load [g]").fill("5000")
    page.locator("#parameter-load_kg-problem").get_by_text(
        "5000 g is not allowed; allowed is at most 100 g."
    ).wait_for()
    before = service.client.get("/experiments").json()["items"]
    page.get_by_role("button", name="Start", exact=True).click()
    page.get_by_text("nothing has moved, nothing is recorded").wait_for()
    assert service.client.get("/experiments").json()["items"] == before
    open_page.expected.append("422")


def test_units_are_switched_for_the_whole_page(open_page):
    page = open_page("#bench?kind=steps&repeats=2")
    page.get_by_label("angle [°]").wait_for()
    page.get_by_title("Units: degrees and grams, or SI").click()
    assert page.get_by_label("angle [rad]").input_value() == "1.5708"
    assert page.get_by_label("load [kg]").input_value() == "0.1"
    page.get_by_title("Units: degrees and grams, or SI").click()
    assert page.get_by_label("angle [°]").input_value() == "90"


def test_a_wrong_token_is_refused_in_the_words_of_the_service(open_page):
    page = open_page(token=False)
    page.get_by_label("Token: to start").fill("wrong")
    page.get_by_role("button", name="Use token").click()
    said = page.get_by_label("Token", exact=True).locator(".problem")
    said.get_by_text("the token is none of this service, was revoked or has expired").wait_for()
    assert "make one with: friction-bench token new" in said.inner_text()
    page.get_by_label("Token: to start").fill(TOKEN)
    page.get_by_role("button", name="Use token").click()
    page.get_by_label("Token: to start").wait_for(state="detached")
    open_page.expected.append("401")


def test_stop_with_a_refused_token_does_not_say_that_there_is_none(open_page):
    page = open_page()
    page.locator(".badge.idle").wait_for()
    page.evaluate("sessionStorage.setItem('friction-bench-token', 'revoked-in-the-meantime')")
    page.keyboard.press("Escape")
    page.locator("#stop-answer").get_by_text("Not stopped: the service refused the token of this page.").wait_for()
    open_page.expected.append("401")


@pytest.mark.parametrize(
    ("reading", "off", "named"),
    [
        ({"current_a": -1.39, "current_measured": False, "current_estimate_a": -1.39}, False, "current from duty"),
        ({"current_a": -1.39, "current_measured": True, "current_estimate_a": -1.2}, False, "motor current"),
        ({"current_a": -1.39, "current_measured": False, "current_estimate_a": -1.39}, True, "last current from duty"),
        ({"current_a": -1.39}, False, "motor current"),  # of a service that does not tell yet
    ],
)
def test_a_current_is_called_what_it_is(open_page, reading, off, named):
    call = f"(m) => m.readingsOf({json.dumps(reading)}, null, {json.dumps(off)}).map((one) => one.innerText)"
    (shown,) = open_page().evaluate(f"{imported('bench/liveplot')}.then({call})")
    assert shown == f"{named}−1.390 A"


@pytest.mark.parametrize(
    ("power_off", "words"),
    [("confirmed", "The drive is off. These are the readings"), ("failed", "The drive may still have power.")],
)
def test_what_is_said_of_old_readings_follows_the_power(open_page, power_off, words):
    facts = {"status": {"reading": {}, "run": {"power_off": power_off}}, "fresh": True, "running": False,
             "reading_age_s": 3}  # fmt: skip
    assert words in open_page().evaluate(
        f"{imported('app/state')}.then((m) => m.readingNote({json.dumps(facts)}).words)"
    )


def test_the_big_numbers_name_the_current_from_duty(service, open_page):
    service.start("steps", pace="real-time", repeats=20)
    page = open_page("#numbers")
    page.locator(".numbers-values dt").get_by_text("current from duty", exact=True).wait_for()
    service.client.post("/stop").raise_for_status()
    page.get_by_text("The drive is off: steps stopped").wait_for()


def test_a_limit_is_said_in_the_units_of_the_page_and_is_in_sight(service, open_page):
    page = open_page(height=800)
    page.get_by_label("angle [°]").fill("500")
    problem = page.locator("#parameter-angle_rad-problem .problem")
    words = "500° is not allowed; allowed is −117.5° to 117.5° (the limits of the bench less a margin of 8.594°)."
    problem.get_by_text(words).wait_for()
    assert page.get_by_label("angle [°]").get_attribute("aria-invalid") == "true"
    page.get_by_text("Not possible on this bench: see the marked field.").wait_for()
    assert all_in_sight(page, problem)
    page.get_by_label("repeats").focus()  # and away from it, with the key
    page.mouse.move(200, 400)
    page.mouse.wheel(0, 2000)
    page.get_by_role("button", name="Start", exact=True).press("Enter")
    page.get_by_text("nothing has moved, nothing is recorded").wait_for()
    assert all_in_sight(page, problem)
    page.get_by_title("Units: degrees and grams, or SI").click()
    page.get_by_label("angle [rad]").fill("90")
    problem.get_by_text("Are degrees meant? 90 degrees are 1.571 rad").wait_for()
    page.get_by_title("Units: degrees and grams, or SI").click()  # kept for all pages of this browser
    open_page.expected.append("422")


def all_in_sight(page, one) -> bool:
    """Whether an element is between the head of the page and the bar with Start."""
    box, bar = one.bounding_box(), page.locator(".start").bounding_box()
    head = page.locator(".top").bounding_box()
    return head["y"] + head["height"] <= box["y"] and box["y"] + box["height"] <= bar["y"]


@pytest.mark.parametrize(
    ("allowed", "words"),
    [
        ({"ge": -1.5707963, "le": 1.5707963}, "180° is not allowed; allowed is −90° to 90°."),
        ({"gt": 3.4906585}, "180° is not allowed; allowed is above 200°."),
        ({"gt": 0, "le": 1.5707963}, "180° is not allowed; allowed is above 0° and at most 90°."),
        ({}, "as the service says it"),
    ],
)
def test_bounds_of_the_service_are_said_as_they_are_meant(open_page, allowed, words):
    error = {"message": "as the service says it", "found": 3.14159265, "allowed": allowed, "unit": "rad"}
    said = open_page().evaluate(f"{imported('ui/form')}.then((m) => m.limitWords({json.dumps(error)}))")
    assert said == words


@pytest.mark.parametrize("motion", ["no-preference", "reduce"])
def test_on_a_narrow_screen_the_page_goes_to_the_joint_that_has_started(service, open_page, motion):
    page = open_page("#bench?kind=steps&repeats=20", width=400, height=800)
    page.emulate_media(reduced_motion=motion)
    live = page.get_by_label("Live", exact=True)
    page.get_by_label("repeats").wait_for()
    assert live.bounding_box()["y"] > 800
    start(page)
    page.evaluate(SETTLED)
    head = page.locator(".top").bounding_box()
    assert head["height"] <= live.bounding_box()["y"] <= head["height"] + 60
    page.keyboard.press("Escape")
    page.locator(".badge.idle").wait_for()
    service.runner.wait(10.0)


def test_where_the_joint_is_in_view_nothing_scrolls_at_a_start(service, open_page):
    page = open_page("#bench?kind=steps&repeats=20", height=800)
    page.get_by_label("repeats").wait_for()
    page.mouse.move(200, 400)
    page.mouse.wheel(0, 150)
    page.evaluate(SETTLED)
    before = page.evaluate("scrollY")
    assert before > 100
    start(page)
    page.wait_for_timeout(700)
    assert page.evaluate("scrollY") == before
    page.keyboard.press("Escape")
    page.locator(".badge.idle").wait_for()
    service.runner.wait(10.0)
