"""Trials that cannot carry a model are told before a study is made; the base model has what the recording adds."""

import pytest

from bench.study.create import SAMPLING_DELAY


@pytest.fixture(scope="module")
def swept(service):
    return [service.run("load-sweep", loads_kg=[0.0, 0.05, 0.1], repeats=1)["experiment_id"] for _ in range(3)]


def check(service, ids, **more):
    answer = service.client.post("/studies/check", json={"experiment_ids": ids, **more})
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_load_sweeps_at_rest_cannot_carry_a_model(service, swept):
    told = check(service, swept, hold_out=["load_kg=0.1"])
    assert told["carries"] is False
    assert "too few" in told["sentence"]
    assert "Record motion" in told["sentence"]
    assert told["rows"] < 20 * told["parameters"]
    assert "load-01-angle-1-01" in told["still"]
    assert service.client.get("/studies").json()["items"] == []


def test_identification_motions_can_and_a_middle_load_is_advised(service):
    how = {"loads_kg": [0.0, 0.05, 0.1], "waveforms": ["slow-sine", "multisine"], "duration_s": 6, "repeats": 2}
    told = check(service, [service.run("excitation", **how)["experiment_id"]])
    assert told["carries"] is True
    assert told["hold_out"] == "load_kg=0.05"


def effects(service, body):
    made = service.client.post("/studies", json=body).json()
    return service.client.get(f"/studies/{made['study_id']}/ladder").json()["rungs"][0]["effects"]


def test_a_study_of_our_own_recordings_knows_their_sampling_delay(service, swept):
    body = {"name": "own", "experiment_ids": swept[:1]}
    assert effects(service, body)[-1] == SAMPLING_DELAY
    assert effects(service, {**body, "base": ["inertia", "coulomb"]}) == ["inertia", "coulomb"]
