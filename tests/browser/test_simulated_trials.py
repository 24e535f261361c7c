"""From trials of the simulated bench to what they say: figures, friction curves, a study and what it asks for."""

import re

import pytest
from playwright.sync_api import Route

from tests.calibration.conftest import SEARCH, SWEEP

pytestmark = pytest.mark.browser
# the simulated joint's friction grows with its load; the first model of a study does not know that
TOLD = {"loads_kg": [0.0, 0.05, 0.1], "waveforms": ["multisine"], "duration_s": 6, "repeats": 2}
LOADED = re.compile("(Load|Weight)-dependent friction")  # so few trials may call it by either formula


@pytest.fixture(scope="module")
def excited(service) -> int:
    return int(service.run("excitation", **TOLD)["experiment_id"])


def held_out_errors(page) -> list[float]:
    cells = page.locator("[aria-label='Ladder'] tbody tr td:nth-child(3)").all_text_contents()
    return [float(cell.split(" ")[0]) for cell in cells]


def test_the_engineer_goes_from_simulated_trials_to_the_trials_that_are_missing(service, open_page, excited):
    page = open_page("#study")
    page.get_by_label("Find experiments").or_(page.get_by_label(f"{excited}: excitation")).first.wait_for()
    page.get_by_label(f"{excited}: excitation").check()
    page.get_by_text("all; leave some out").click()
    used = page.get_by_role("group", name="Trials that are used")
    used.get_by_text("load", exact=True).click()
    used.get_by_label("100 g").uncheck()
    held = page.get_by_role("group", name="Held out of the fit")
    held.get_by_label("2", exact=True).check()
    page.get_by_role("button", name="Create study").click()
    page.get_by_text("2 training trials, 2 held out").wait_for()
    assert service.client.get(f"/studies/{page.evaluate('location.hash').split('/')[1]}").json()["trials"]

    page.get_by_role("link", name="All studies").click()
    page.get_by_label(f"{excited}: excitation").check()
    held.get_by_label("2", exact=True).check()
    page.get_by_label("Name").fill("simulated")
    page.get_by_role("button", name="Create study").click()
    page.get_by_text("3 training trials, 3 held out").wait_for()
    page.get_by_role("link", name="3 Diagnose").click()
    page.get_by_role("button", name="Diagnose").click()
    named = page.locator("article").filter(has_text="candidate")
    named.filter(has_text=LOADED).first.wait_for()

    page.get_by_role("link", name="1 Record").click()
    page.get_by_role("button", name="Suggest trials").click()
    page.get_by_role("button", name="Queue all of them").click()
    page.get_by_text(re.compile(r"\d+ in the queue")).wait_for()
    service.client.post("/queue/resume").raise_for_status()
    deadline = 300
    while (queue := service.client.get("/queue").json())["running"] or queue["waiting"]:
        page.wait_for_timeout(100)
        deadline -= 1
        assert deadline, queue
    late: list[Route] = []  # what the page asks of a trial is answered late
    page.route(re.compile(r"/trials/\d+$"), lambda route: late.append(route))
    page.get_by_role("button", name="Add the recorded trials to the study").click()
    page.get_by_text(re.compile(r"^([4-9]|\d\d) training trials, \d+ held out")).wait_for()

    page.get_by_role("link", name="1 Record").click()
    page.get_by_role("button", name="Record the next round").click()
    for route in late:
        route.continue_()
    page.unroute(re.compile(r"/trials/\d+$"))
    page.get_by_text(re.compile(r"\d in the queue\. When they have ended|Nothing is queued")).wait_for()
    service.client.delete("/queue").raise_for_status()

    page.get_by_role("link", name="3 Diagnose").click()
    page.get_by_role("button", name="Diagnose").click()
    named.filter(has_text=LOADED).first.get_by_role("button", name="Add").click()
    page.get_by_role("button", name="Undo this change").wait_for()
    *_, before, after = held_out_errors(page)
    assert after < before

    with page.expect_download() as download:
        page.get_by_role("button", name=re.compile("^Report of study")).click()
    report = download.value.path().read_text()
    assert download.value.suggested_filename.endswith(".html")
    assert "simulated" in report
    assert 'src="http' not in report  # filed, it shows itself without a network


def test_trials_are_handed_over_as_parquet_and_their_figure_is_drawn(open_page, excited):
    parquet = pytest.importorskip("pyarrow.parquet")
    page = open_page("#trials")
    page.get_by_role("button", name=f"Trials of experiment {excited}", exact=True).click()
    page.locator("[aria-label='Current over speed'] .trace").nth(5).wait_for()
    with page.expect_download() as download:
        page.get_by_role("button", name=f"Parquet of experiment {excited}", exact=True).click()
    table = parquet.read_table(download.value.path())
    assert {"trial_id", "time_s", "position_rad", "condition_load_kg"} <= set(table.column_names)
    assert len(set(table["trial_id"].to_pylist())) == 6


def test_friction_curves_are_calibrated_shown_and_chosen(service, open_page):
    ids = [service.run(kind, **how)["experiment_id"] for kind, how in (("speed-sweep", SWEEP), ("load-sweep", SEARCH))]
    page = open_page("#trials")
    page.get_by_label("From experiments").fill(", ".join(str(one) for one in ids))
    page.get_by_role("button", name="Calibrate").click()
    page.locator("[aria-label^='Friction current over speed'] .trace").first.wait_for()
    curves = page.get_by_role("region", name="Friction curves")
    curves.get_by_text("in use", exact=True).wait_for()
    page.get_by_role("button", name="Calibrate").click()  # once more: the newest is in use
    use = page.get_by_role("button", name=re.compile("^Use calibration")).first
    use.wait_for()
    wanted = str(use.get_attribute("aria-label"))
    use.click()
    page.get_by_role("button", name=wanted, exact=True).wait_for(state="detached")
    used = service.client.get("/calibrations/in-use").json()["calibration_id"]
    assert wanted == f"Use calibration {used}"
    page.get_by_label("From experiments").fill("9999")
    page.get_by_role("button", name="Calibrate").click()
    page.get_by_label("Friction curves", exact=True).first.get_by_text("9999").wait_for()
    service.client.delete("/calibrations/in-use")
    # the browser logs the refused request itself
    open_page.expected.append("404")
