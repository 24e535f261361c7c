"""Files of another bench on the page: their columns are shown, questions answered, and they come in."""

import pytest

from tests.recording_set.foreign_files import FILES

pytestmark = pytest.mark.browser


def chosen(name: str) -> dict[str, object]:
    return {"name": "bench 7.csv", "mimeType": "text/csv", "buffer": FILES[name].data}


def test_a_german_spreadsheet_comes_in_once_its_columns_are_confirmed(service, open_page):
    before = service.client.get("/experiments").json()["items"]
    page = open_page("#trials")
    page.get_by_text("Import a recording set, or files of any bench").click()
    page.get_by_label("Recording set (.zip), or files").set_input_files([chosen("german excel, windows-1252")])
    page.get_by_role("button", name="Import", exact=True).click()
    columns = page.get_by_role("region", name="Columns")
    columns.get_by_role("option", name="position_rad").first.wait_for(state="attached")
    # nothing comes in before somebody has looked
    assert service.client.get("/experiments").json()["items"] == before
    page.get_by_role("button", name="These columns are right").click()
    page.get_by_text("Imported 1 trials").wait_for()
    made = next(one for one in service.client.get("/experiments").json()["items"] if one["kind"] == "import")
    trial = service.client.get("/trials", params={"experiment_id": made["experiment_id"]}).json()["items"][0]
    assert trial["rows"] == 400


def test_a_speed_of_the_motor_and_recordings_that_are_there_already_are_told(service, open_page):
    for _ in range(2):
        page = open_page("#trials")
        page.get_by_text("Import a recording set, or files of any bench").click()
        page.get_by_label("Recording set (.zip), or files").set_input_files([chosen("speed of the motor")])
        page.get_by_role("button", name="Import", exact=True).click()
        page.get_by_text("of the motor side, behind a gear of about 50").wait_for()
        page.get_by_text("or choose not used for 'Drehzahl [U/min]'").wait_for()
        page.get_by_role("button", name="These columns are right").click()
        page.get_by_text("Imported 1 trials").wait_for()
    page.get_by_text("has the same recordings already").wait_for()


def test_a_question_is_asked_and_answered(service, open_page):
    page = open_page("#trials")
    page.get_by_text("Import a recording set, or files of any bench").click()
    page.get_by_label("Recording set (.zip), or files").set_input_files([chosen("counts, not told")])
    page.get_by_role("button", name="Import", exact=True).click()
    page.get_by_role("alert").get_by_text("counts per turn N (of the joint), or choose position [deg] for '").wait_for()
    page.get_by_label("Counts per turn of the joint").fill("16384")
    page.get_by_role("button", name="Answer").click()
    page.get_by_role("button", name="These columns are right").click()
    page.get_by_text("Imported 1 trials").wait_for()


def test_what_a_column_is_taken_for_is_chosen_in_the_table(service, open_page):
    page = open_page("#trials")
    page.get_by_text("Import a recording set, or files of any bench").click()
    page.get_by_label("Recording set (.zip), or files").set_input_files([chosen("counts, not told")])
    page.get_by_role("button", name="Import", exact=True).click()
    page.get_by_role("alert").get_by_text("is in counts").wait_for()
    column = page.locator("main").get_by_role("alert").inner_text().split("'")[1]
    page.get_by_label(f"What {column} is").select_option("position[deg]")
    page.get_by_role("button", name="These columns are right").wait_for()
    page.get_by_label(f"What {column} is").select_option("ignore")
    page.get_by_role("alert").get_by_text("no column is a position").wait_for()
    page.get_by_label(f"What {column} is").select_option("")
    page.get_by_role("alert").get_by_text("is in counts").wait_for()
