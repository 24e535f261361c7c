"""A study on the page beyond one model: two models beside each other, undo and redo, and files of what is shown."""

import json

import pytest

from tests.browser.browser import intercept
from tests.service.recorded_joint import recording_set_zip

pytestmark = pytest.mark.browser
HELD_OUT = (["amplitude_rad=0.9"], ["repeat=2"])


@pytest.fixture(scope="module")
def studies(service) -> list[int]:
    """Two studies of one recording set."""
    headers = {"Content-Type": "application/zip"}
    made = service.client.post("/recording-sets?name=two", content=recording_set_zip(), headers=headers).json()
    bodies = [{"name": "two", "experiment_ids": [made["experiment_id"]], "hold_out": one} for one in HELD_OUT]
    return [service.client.post("/studies", json=body).json()["study_id"] for body in bodies]


@pytest.fixture
def changed(service, studies) -> tuple[int, int]:
    """The models of the first study: the base, and one with an effect more; the latter is removed afterwards."""
    made = service.client.post(f"/studies/{studies[0]}/models", json={"effect": "viscous_asymmetry"}).json()
    yield made["parent_id"], made["model_id"]
    for rung in service.client.get(f"/studies/{studies[0]}/ladder").json()["rungs"][:0:-1]:
        service.client.delete(f"/studies/{studies[0]}/models/{rung['model_id']}")


def test_two_models_stand_beside_each_other_and_have_an_address(open_page, studies, changed):
    page = open_page(f"#compare/{studies[0]}.{changed[0]}/{studies[0]}.{changed[1]}", width=1440)
    page.get_by_text("The second is closer in 6 of the 6 trials that both use.").wait_for()
    page.get_by_text(f"residual second, {studies[0]}.{changed[1]}").wait_for()
    row = page.locator("[aria-label='Parameters of both models, with 95 % intervals'] tr", has_text="viscous asymmetry")
    assert row.locator("td").nth(2).inner_text() == "–"
    page.get_by_label("The second: study").select_option(str(studies[1]))
    page.locator("[aria-label='Error of each trial'] td", has_text="(held out)").first.wait_for()
    page.wait_for_url(f"**#compare/{studies[0]}.{changed[0]}/{studies[1]}.*")
    page.reload()
    page.get_by_text("trials that both use.").wait_for()
    assert page.get_by_label("The second: study").input_value() == str(studies[1])


def test_trials_of_two_units_that_were_run_alike_stand_in_one_row(service, open_page, studies):
    headers = {"Content-Type": "application/zip"}
    made = service.client.post("/recording-sets?name=unit", content=recording_set_zip(), headers=headers).json()
    unit = service.client.post("/studies", json={"name": "unit", "experiment_ids": [made["experiment_id"]]}).json()
    page = open_page(f"#compare/{studies[0]}./{unit['study_id']}.", width=1440)
    page.get_by_text("They share no trial, so each is judged on its own trials.").wait_for()
    rows = page.locator("[aria-label='Error of each trial'] tbody tr")
    assert rows.count() == len(unit["trials"])
    assert all("not used" not in row and row.count("%") == 2 for row in rows.all_inner_texts())
    offered = page.locator(".study-plots option").all_inner_texts()
    assert {one.rsplit(", ", 1)[1] for one in offered} == {"first", "second"}
    assert len(set(offered)) == 2 * len(unit["trials"])
    service.client.request("DELETE", f"/studies/{unit['study_id']}", params={"reason": "test"})


def test_a_change_is_undone_from_any_step_and_done_again(service, open_page, studies, changed):
    page = open_page(f"#study/{studies[0]}/result", width=1440)
    page.get_by_role("button", name="Undo + viscous asymmetry").click()
    page.get_by_text("Undone: model").wait_for()
    assert len(service.client.get(f"/studies/{studies[0]}/ladder").json()["rungs"]) == 1
    page.get_by_role("button", name="Redo").click()
    page.locator(".study-head").get_by_text("the error falls from").wait_for()
    page.get_by_role("button", name="Undo this change").wait_for()


@pytest.mark.parametrize("asked", ["compare", "error-map"])
def test_a_change_is_undone_while_its_comparison_is_still_under_way(open_page, studies, changed, asked):
    page, held = open_page("#study", width=1440), []
    intercept(page, f"**/{asked}?*", lambda route: held.append(route))
    page.goto(page.url.split("#")[0] + f"#study/{studies[0]}/result")
    page.get_by_role("button", name="Undo + viscous asymmetry").wait_for()
    while not held:
        page.wait_for_timeout(100)
    page.get_by_role("button", name="Undo + viscous asymmetry").click()
    page.wait_for_timeout(500)  # in which the model was removed, and its comparison asked for what is gone
    for one in held:
        one.continue_()
    page.unroute(f"**/{asked}?*")
    page.get_by_text("Undone: model").wait_for()


def test_a_model_and_its_plots_are_kept_as_files(open_page, studies, changed):
    page = open_page(f"#study/{studies[0]}/result", width=1440)
    page.locator(".plot.ladder .trace").first.wait_for()

    def saved(press) -> tuple[str, bytes]:
        with page.expect_download() as found:
            press.click()
        return found.value.suggested_filename, found.value.path().read_bytes()

    name, content = saved(page.get_by_role("button", name=f"Save model {changed[1]} as JSON"))
    model = json.loads(content)
    assert name == f"study-{studies[0]}-model-{changed[1]}.json"
    assert "viscous_asymmetry" in model["effects"]
    assert {one["unit"] for one in model["parameters"]}
    table = saved(page.get_by_role("button", name="Save the parameters"))[1].decode().splitlines()
    assert len(table) == 1 + len(model["parameters"])
    assert saved(page.get_by_role("button", name="Save the picture", exact=True).first)[1].startswith(b"\x89PNG")
    numbers = saved(page.get_by_role("button", name="Save its numbers", exact=True).first)[1].decode().splitlines()
    assert numbers[0] == "line,time in the trial [s],value"
    assert {line.split(",")[0] for line in numbers[1:]} == {"measured", "predicted", "residual"}
    page.locator(".plot.ladder").hover()
    assert saved(page.locator(".plot.ladder [data-title='Save the picture (SVG)']"))[1].startswith(b"<svg")
    assert b"held-out" in saved(page.locator(".plot.ladder [data-title='Save its numbers (CSV)']"))[1]


def test_units_of_one_kind_stand_beside_each_other(service, open_page, studies):
    numbers = service.client.get(f"/studies/{studies[0]}").json()
    experiment = service.client.get(f"/trials/{numbers['trials'][0]['trial_id']}").json()["experiment_id"]
    third = service.client.post("/studies", json={"name": "unit 3", "experiment_ids": [experiment]}).json()["study_id"]
    page = open_page("#study", width=1440)
    page.get_by_text("Units of one kind").click()
    units = page.locator("details", has_text="Units of one kind")
    compare = page.get_by_role("button", name="Compare units")
    units.get_by_label(f"{studies[0]}: ").check()
    compare.click()
    page.get_by_text("Choose at least 2.").wait_for()
    units.get_by_label(f"{third}: ").check()
    compare.click()
    page.get_by_text("each of the", exact=False).wait_for()  # intervals of the differences holds by itself
    told = service.client.get(f"/studies/{studies[0]}/units?beside={third}").json()
    two = page.locator("[aria-label='What differs between the two units'] tbody tr")
    assert two.count() == len(told["differences"])
    assert page.locator("[aria-label='What units have in common']").count() == 0
    assert page.locator("tr.chosen").count() == 0
    told["differences"][1] |= {"low": 0.1, "high": 0.3}
    intercept(page, "**/units?*", lambda route: route.fulfill(json=told))
    compare.click()
    name = told["differences"][1]["name"].replace("_", " ")
    page.locator("tr.chosen").get_by_text(name, exact=True).wait_for()
    page.unroute("**/units?*")
    units.get_by_label(f"{studies[1]}: ").check()
    compare.click()
    page.get_by_text("None of the 3 units is shown to be an outlier.").wait_for()
    rows = page.locator("[aria-label='Each unit beside the others'] tr", has_text="unit 3")
    assert rows.count() == page.locator("[aria-label='What units have in common'] tbody tr").count()
    service.client.request("DELETE", f"/studies/{third}", params={"reason": "test"})
