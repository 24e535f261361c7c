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
    page.get_by_label("Search").fill("100 g 90° load-sweep")
    page.get_by_text(re.compile(r"^1 to 1 of 1 trials")).wait_for()
    page.get_by_label("Search").fill("90° load-sweep")
    page.get_by_text(re.compile(r"^1 to 2 of 2 trials")).wait_for()
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
    assert "#trials/" in page.url
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


@pytest.fixture
def many(service):
    """More trials than fit on a page, and more than one answer holds."""
    fill_with(service.store, 1100)
    return service


def fill_with(store, count: int) -> None:
    experiment = store.begin_experiment("steps", {}, "simulated", {}, {"name": "paper"})
    for number in range(count):
        writer = store.begin_trial(
            experiment, f"n-{number:05d}", "steps", {"load_kg": 0.001 * (number % 7)}, ["time_s"]
        )
        writer.finish("completed", "", {})
    store.finish_experiment(experiment, "completed", "", {})


def test_every_trial_is_in_reach_and_its_page_has_an_address(many, open_page):
    page = open_page("#trials?words=n-0&sort=name")
    table = page.get_by_role("region", name="Trials")
    table.get_by_text("n-00000").wait_for()
    page.get_by_role("button", name="Last").click()
    table.get_by_text("n-01099").wait_for()
    assert page.evaluate("document.querySelectorAll('*').length") < 1500
    page.reload()
    table.get_by_text("n-01099").wait_for()
    assert page.get_by_label("Search").input_value() == "n-0"
    page.get_by_title("Sort by name").click()
    table.locator("tbody tr").first.get_by_text("n-01099").wait_for()
    page.get_by_label("Outcome").select_option("tripped")
    page.get_by_text("No trial is like that.").wait_for()
    page.go_back()
    table.locator("tbody tr").first.get_by_text("n-01099").wait_for()
    page.go_back()
    table.locator("tbody tr").last.get_by_text("n-01099").wait_for()


def test_a_trial_has_an_address_and_the_joint_moves_as_it_did(service, open_page, experiment):
    trial = service.client.get("/trials", params={"experiment_id": experiment}).json()["items"][-1]
    page = open_page(f"#trials/{trial['trial_id']}")
    page.get_by_role("group", name=f"Trial {trial['trial_id']}: ").first.wait_for()
    joint = page.get_by_role("img", name=f"The joint in trial {trial['trial_id']}")
    joint.wait_for()
    before = joint.get_attribute("aria-label")
    page.get_by_role("button", name="Play").click()
    page.wait_for_function("(label) => document.querySelector('.trial-joint svg').ariaLabel !== label", arg=before)
    page.get_by_role("button", name="Pause").click()


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("#nonsense", "There is no such page"),
        ("#trials/99999", "trial 99999 is not in the store"),
        ("#study/9999", "study 9999"),
        ("#learn/nonsense", "There is no effect nonsense"),
        ("#%E0%A4%A", "There is no such page"),
    ],
)
def test_an_address_that_leads_nowhere_says_so(open_page, address, said):
    page = open_page(address)
    page.get_by_text(said).first.wait_for()
    assert page.locator("main .panel").count() <= 4
    open_page.expected.append("404")
