"""A sequential calibration over REST: how far it is, pause, resume, STOP, and going on with what was measured."""

import time

import pytest

from tests.service.running_service import running_service

QUICK = {"loads_kg": [0.0, 0.1], "accuracy_a": 1.0, "budget_s": 30.0, "duties": [0.2]}


@pytest.fixture
def bench(tmp_path):
    with running_service(tmp_path) as running:
        yield running


def now(service):
    return service.client.get("/calibrations/run").json()


def waited(service, *states):
    deadline_s = time.monotonic() + 100.0
    while (found := now(service))["state"] not in states:
        assert time.monotonic() < deadline_s, found
        time.sleep(0.01)
    return found


def begun(service, **wanted):
    made = service.client.post("/calibrations/run", json={**QUICK, **wanted})
    assert made.status_code == 201, made.text
    return made.json()


@pytest.mark.timeout(240)
def test_it_says_how_far_it_is_and_ends_in_a_calibration(bench):
    assert now(bench)["state"] == "none"
    begun(bench, note="spring")
    seen = []
    while (found := now(bench))["state"] in ("running", "fitting"):
        seen.append(found)
        time.sleep(0.01)
    assert found["state"] == "calibrated", found["reason"]
    spent = [one["spent_s"] for one in seen]
    assert spent[0] < spent[-1]
    middle = seen[len(seen) // 2]
    assert 0.0 < middle["progress"] < 1.0
    assert middle["left_s"] > 0.0
    assert {one["load_kg"] for one in seen} >= {None, 0.0, 0.1}
    made = bench.client.get(f"/calibrations/{found['calibration_id']}").json()
    assert made["experiment_ids"] == found["experiment_ids"]
    assert made["note"] == "spring"
    assert made["in_use"] is True


@pytest.mark.timeout(240)
def test_it_pauses_after_the_trial_and_goes_on(bench):
    begun(bench)
    while now(bench)["spent_s"] == 0.0:  # until an experiment runs: it is paused after its trial, not after its end
        time.sleep(0.01)
    assert bench.client.post("/calibrations/run/pause").json()["state"] in ("pausing", "paused")
    paused = waited(bench, "paused")
    time.sleep(0.3)
    assert now(bench) == paused  # nothing moves
    found = bench.client.get("/bench").json()
    assert found["reading"]["power"] == "disabled"
    assert found["run"]["pausing"] == "paused"
    assert bench.client.post("/experiments", json={"kind": "steps"}).status_code == 409
    bench.client.post("/calibrations/run/resume")
    assert waited(bench, "calibrated", "ended")["reason"] == ""
    assert bench.client.post("/calibrations/run/pause").status_code == 409


@pytest.mark.timeout(240)
def test_stop_ends_it_and_what_was_measured_counts_along_later(bench):
    begun(bench)
    while not now(bench)["experiment_ids"]:
        time.sleep(0.01)
    bench.client.post("/stop", json={"reason": "lunch"})
    ended = waited(bench, "ended")
    assert "lunch" in ended["reason"]
    before = ended["experiment_ids"]
    assert bench.client.get("/lease").json()["lease"] is None
    begun(bench, after=before)
    found = waited(bench, "calibrated", "ended")
    assert found["reason"] == ""
    assert found["experiment_ids"][: len(before)] == before
    kinds = [one["kind"] for one in bench.client.get("/experiments").json()["items"]]
    assert kinds.count("load-sweep") == 1  # F_load was not searched again


def test_nothing_else_starts_meanwhile_and_records_that_are_not_there_are_named(bench):
    assert bench.client.post("/calibrations/run", json={"after": [77]}).status_code == 404
    begun(bench)
    again = bench.client.post("/calibrations/run", json=QUICK)
    assert (again.status_code, again.json()["kind"]) == (409, "BusyError")
    refused = bench.client.post("/experiments", json={"kind": "steps"})
    assert "calibration run 1 is under way" in refused.json()["detail"]
    bench.client.post("/stop")
    waited(bench, "ended")
