"""Calibrations over REST."""

import pytest

from tests.calibration.conftest import SEARCH, SWEEP


@pytest.fixture(scope="module")
def made(service):
    ids = [service.run(kind, **parameters)["experiment_id"] for kind, parameters in (
        ("speed-sweep", SWEEP), ("load-sweep", SEARCH))]  # fmt: skip
    answer = service.client.post("/calibrations", json={"experiment_ids": ids, "note": "over REST"})
    assert answer.status_code == 201, answer.text
    found = answer.json()
    assert answer.headers["location"] == f"/api/v1/calibrations/{found['calibration_id']}"
    return found


def test_a_calibration_is_listed_shown_and_in_use(service, made):
    assert made["in_use"] is True
    assert [curve["load_kg"] for curve in made["curves"]] == [0.0, 0.1]
    low, high = (made["curves"][1]["parameters"]["coulomb_a"][name] for name in ("low", "high"))
    assert low < made["curves"][1]["coulomb_a"] < high
    assert service.stranger.get("/calibrations/in-use").json() == made
    assert service.stranger.get(f"/calibrations/{made['calibration_id']}").json() == made
    assert made in service.stranger.get("/calibrations").json()["items"]


def test_its_picture_can_be_drawn(service, made):
    picture = service.stranger.get(f"/calibrations/{made['calibration_id']}/picture").json()
    assert len(picture["curves"]) == 2
    assert len(picture["curves"][0]["points"]["friction_a"]) == made["curves"][0]["points"]


def test_one_is_named_and_taken_back(service, made):
    second = service.client.post("/calibrations", json={"experiment_ids": made["experiment_ids"]}).json()
    used = service.client.post(f"/calibrations/{made['calibration_id']}/use").json()
    assert used["in_use"]
    assert used["chosen_utc"]
    latest = service.client.delete("/calibrations/in-use").json()
    assert latest["calibration_id"] == second["calibration_id"]


def test_changing_needs_the_token_and_what_is_wrong_is_named(service, made):
    assert service.stranger.post("/calibrations", json={"experiment_ids": [1]}).status_code == 401
    assert service.stranger.post(f"/calibrations/{made['calibration_id']}/use").status_code == 401
    assert service.stranger.delete("/calibrations/in-use").status_code == 401
    assert service.client.post("/calibrations", json={"experiment_ids": [9999]}).status_code == 404
    assert service.client.post("/calibrations/9999/use").status_code == 404
    refused = service.client.post("/calibrations", json={"experiment_ids": made["experiment_ids"][1:]})
    assert refused.status_code == 422
    assert "0 trials of the balanced arm" in refused.json()["detail"]
