"""POST /studies/N/rounds: what was recorded is picked up, what is asked for next is queued."""

import importlib
import time

import pytest

from bench.store.tables.queue import RUNNING, WAITING

SUGGEST = importlib.import_module("bench.study.suggestion.suggest")
MOTIONS = {"loads_kg": [0.0, 0.05], "waveforms": ["slow-sine", "multisine"], "duration_s": 4.0, "repeats": 1}


@pytest.fixture
def path(service, monkeypatch):
    from bench.study.suggestion.options import choices

    monkeypatch.setattr(SUGGEST, "choices", lambda *args: choices(*args)[::12])  # the whole lot takes seconds
    recorded = service.run("excitation", **MOTIONS)["experiment_id"]
    made = service.client.post("/studies", json={"name": "rounds", "experiment_ids": [recorded]}).json()
    yield f"/studies/{made['study_id']}"
    service.client.delete("/queue")
    service.client.post("/queue/resume")


def test_a_round_is_queued_and_the_next_one_picks_it_up(service, path):
    service.client.post("/queue/pause").raise_for_status()
    first = service.client.post(f"{path}/rounds", json={"trials": 1})
    assert first.status_code == 201, first.text
    found = first.json()
    assert found["extended"] is None
    assert [one["note"] for one in service.client.get("/queue").json()["waiting"]] == [found["suggested"]["note"]]
    again = service.client.post(f"{path}/rounds", json={"trials": 1})
    assert again.status_code == 409
    assert "in the queue yet" in again.json()["detail"]
    service.client.post("/queue/resume").raise_for_status()
    deadline = time.monotonic() + 60.0
    while service.client.get(f"/queue/{found['item_ids'][0]}").json()["state"] in (WAITING, RUNNING):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    service.client.post("/queue/pause").raise_for_status()
    second = service.client.post(f"{path}/rounds", json={"trials": 1}).json()
    assert second["extended"]["added"]
    assert second["suggested"]["model_id"] == second["extended"]["model_id"]
    assert second["suggested"]["kept_out"] == []


def test_a_round_needs_a_token_that_may_start_and_moves_the_joint_once(service, path):
    service.client.post("/queue/pause").raise_for_status()
    assert service.stranger.post(f"{path}/rounds", json={}).status_code == 401
    with service.with_token("reader of rounds", "viewer") as viewer:
        assert viewer.post(f"{path}/rounds", json={}).status_code == 403
    assert service.client.get("/queue").json()["waiting"] == []
    assert service.client.post("/studies/9999/rounds", json={}).status_code == 404
