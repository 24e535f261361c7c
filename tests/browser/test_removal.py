"""A record is removed by a button, after a question, with a reason."""

import re

import pytest

from tests.queue.waiting import wait_for
from tests.service.recorded_joint import recording_set_zip, study_path

pytestmark = pytest.mark.browser


@pytest.fixture
def number(service) -> int:
    headers = {"Content-Type": "application/zip"}
    made = service.client.post("/recording-sets?name=gone", content=recording_set_zip(), headers=headers).json()
    return made["experiment_id"]


def test_an_experiment_goes_once_a_reason_is_given(open_page, service, number):
    page = open_page("#trials")
    page.get_by_role("button", name=f"Remove experiment {number}", exact=True).click()
    question = page.get_by_role("form", name=f"Remove experiment {number}")
    question.get_by_text("with its trials and all that was recorded in them, for good?").wait_for()
    question.get_by_role("button", name="Remove for good").click()  # the browser asks for the reason first
    assert service.client.get(f"/experiments/{number}").status_code == 200
    question.get_by_label("Why").fill("wrong arm")
    question.get_by_role("button", name="Remove for good").click()
    page.get_by_role("button", name=f"Remove experiment {number}", exact=True).wait_for(state="detached")
    assert service.client.get(f"/experiments/{number}").status_code == 404
    deed = rf'"removed experiment {number} [^"]*: wrong arm"'
    wait_for(lambda: re.search(deed, service.client.get("/audit", params={"limit": 20}).text))  # a thread writes it


def test_what_is_kept_stays_and_a_study_goes_without_its_trials(open_page, service):
    number = study_path(service, "removed").split("/")[-1]
    trial = service.client.get(f"/studies/{number}").json()["trials"][0]["trial_id"]
    page = open_page("#study")
    remove = page.get_by_role("button", name=f"Remove study {number}", exact=True)
    remove.click()
    page.get_by_role("button", name="Keep it").click()
    assert service.client.get(f"/studies/{number}").status_code == 200
    remove.click()
    page.get_by_label("Why").fill("made twice")
    page.get_by_role("button", name="Remove for good").click()
    remove.wait_for(state="detached")
    assert service.client.get(f"/studies/{number}").status_code == 404
    assert service.client.get(f"/trials/{trial}").status_code == 200
