"""Starting, watching, stopping."""

import json
import time
from concurrent.futures import ThreadPoolExecutor
from threading import Event

import httpx
import pytest

from bench.control import station
from bench.control.drive_factory import Equipment
from bench.control.technician import PersonTechnician
from tests.control.fake_drive import FakeDrive


def test_kinds_have_a_schema_with_units_bounds_and_defaults(service):
    kinds = {kind["name"]: kind for kind in service.stranger.get("/experiment-kinds").json()["items"]}
    assert {"steps", "load-sweep", "excitation"} <= set(kinds)
    repeats = kinds["steps"]["parameters"]["properties"]["repeats"]
    assert (repeats["minimum"], repeats["maximum"], repeats["default"]) == (1, 1000, 25)
    for kind in kinds.values():
        for name, schema in kind["parameters"]["properties"].items():
            assert schema["description"], (kind["name"], name)
            assert "unit" in schema, (kind["name"], name)


def test_a_run_from_start_to_record(idle):
    found = idle.run("steps", repeats=1, load_kg=0.05)
    assert found["outcome"] == "completed"
    assert found["source"] == "simulated"
    assert found["parameters"]["load_kg"] == 0.05
    assert found["provenance"]["software"]["version"]
    listed = idle.stranger.get("/experiments", params={"limit": 1}).json()
    assert listed["items"][0]["experiment_id"] == found["experiment_id"]
    status = idle.stranger.get("/bench").json()
    assert status["simulated"] is True
    assert status["state"] == "idle"
    assert status["run"]["experiment_id"] == found["experiment_id"]
    assert status["drive"]["watchdog_s"] > 0


def test_the_answer_says_where_the_experiment_is(idle):
    answer = idle.client.post("/experiments", json={"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"})
    assert answer.headers["location"] == f"/api/v1/experiments/{answer.json()['experiment_id']}"
    assert idle.client.get(idle.url + answer.headers["location"]).json()["kind"] == "steps"


def test_outside_the_limits_is_refused_before_motion_with_value_limit_and_unit(idle):
    answer = idle.client.post("/experiments", json={"kind": "steps", "parameters": {"load_kg": 5}})
    assert answer.status_code == 422
    problem = answer.json()
    assert problem["kind"] == "LimitError"
    assert "load_kg is 5 kg; allowed is at most 0.1 kg" in problem["detail"]
    latest = idle.client.get("/experiments", params={"limit": 1}).json()["items"][0]
    assert (latest["outcome"], latest["parameters"]) == ("refused", {"load_kg": 5})
    assert idle.client.get("/trials", params={"experiment_id": latest["experiment_id"]}).json()["items"] == []


def test_wrong_values_are_named_field_by_field(idle):
    body = {"kind": "steps", "parameters": {"load_kg": -1, "repeats": "many", "colour": "red"}}
    problem = idle.client.post("/experiments", json=body).json()
    errors = {error["field"]: error for error in problem["errors"]}
    assert set(errors) == {"parameters.load_kg", "parameters.repeats", "parameters.colour"}
    assert errors["parameters.load_kg"]["unit"] == "kg"
    assert errors["parameters.load_kg"]["allowed"] == {"ge": 0}
    assert errors["parameters.repeats"]["found"] == "many"


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ({"kind": "dance"}, 404),
        ({}, 422),
        ({"kind": "steps", "surprise": 1}, 422),
        ({"kind": "steps", "pace": "slow"}, 422),
        ([], 422),
        ({"kind": "steps", "parameters": {"angle_rad": 3.0}}, 422),
    ],
)
def test_bad_starts_are_problems(idle, body, status):
    answer = idle.client.post("/experiments", json=body)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["detail"]


def test_a_body_that_is_no_json_is_a_problem(idle):
    answer = idle.client.post("/experiments", content=b"{", headers={"Content-Type": "application/json"})
    assert answer.status_code == 422
    assert answer.headers["content-type"] == "application/problem+json"


def test_one_at_a_time_and_stop(idle):
    first = idle.start("steps", pace="real-time", repeats=5)
    answer = idle.client.post("/experiments", json={"kind": "steps"})
    assert answer.status_code == 409
    assert f"experiment {first}" in answer.json()["detail"]
    time.sleep(0.5)
    stopped = idle.client.post("/stop", json={"reason": "cable is caught"}).json()
    assert stopped["was_running"] is True
    assert idle.runner.wait(2.0)
    record = idle.client.get(f"/experiments/{first}").json()
    assert record["outcome"] == "stopped"
    assert "cable is caught" in record["reason"]
    trial = idle.client.get("/trials", params={"experiment_id": first}).json()["items"][0]
    assert trial["outcome"] == "stopped"
    assert trial["rows"] > 50


def test_stop_without_a_body_and_with_nothing_running(idle):
    answer = idle.client.post("/stop")
    assert answer.status_code == 200
    assert answer.json() == {"detail": "Nothing was running on this service.", "was_running": False}


def test_stop_gets_through_while_every_worker_thread_is_busy(idle, monkeypatch):
    stopped = Event()

    def slowly(*_args, **_kwargs):
        stopped.wait(1.5)
        return []

    monkeypatch.setattr(type(idle.store), "experiments", slowly)
    idle.start("steps", pace="real-time", repeats=5)
    limits = httpx.Limits(max_connections=100)
    readers = httpx.Client(base_url=f"{idle.url}/api/v1", limits=limits, timeout=30)
    with readers, ThreadPoolExecutor(60) as pool:
        waiting = [pool.submit(readers.get, "/experiments") for _ in range(60)]
        time.sleep(0.4)
        begun_s = time.monotonic()
        assert idle.client.post("/stop").status_code == 200
        took_s = time.monotonic() - begun_s
        busy = sum(not one.done() for one in waiting)
        stopped.set()  # those that wait need not take as long any more
    assert busy > 20, "the readers were not busy; the test shows nothing"
    assert took_s < 0.7
    assert idle.runner.wait(2.0)


def test_nothing_that_is_read_starts_motion(idle):
    paths = idle.client.get("/openapi.json").json()["paths"]
    before = idle.store.experiments(limit=1)[0].id
    for path, item in paths.items():
        if "get" in item and "{" not in path and not path.endswith("/live"):
            idle.client.get(idle.url + path)
    assert idle.runner.status().outcome != "running"
    assert idle.store.experiments(limit=1)[0].id == before


def test_live_rows_by_polling_are_the_recorded_rows(idle):
    experiment_id = idle.start("steps", pace="real-time", repeats=1)
    rows, after_row, end_s = [], -1, time.monotonic() + 10.0
    while len(rows) <= 100:
        assert time.monotonic() < end_s
        time.sleep(0.15)
        answer = idle.stranger.get("/live/now", params={"after_row": after_row}).json()
        assert answer["status"]["state"] == "running"
        if answer["rows"]["restarted"]:
            rows = []
        rows += answer["rows"]["rows"]
        after_row = answer["rows"]["last_row"]
        channels = answer["rows"]["channels"]
    idle.client.post("/stop")
    assert idle.runner.wait(5.0)
    trial = idle.store.trials(experiment_id)[0]
    time_s = idle.store.samples(trial.id)["time_s"]
    assert [row[channels.index("time_s")] for row in rows] == time_s[: len(rows)].tolist()


def test_live_stream_sends_status_and_rows(idle):
    idle.start("steps", pace="real-time", repeats=1)
    names, rows = set(), 0
    with httpx.stream("GET", f"{idle.url}/api/v1/live", timeout=10) as stream:
        assert stream.headers["content-type"].startswith("text/event-stream")
        event = ""
        for line in stream.iter_lines():
            if line.startswith("event: "):
                event = line.removeprefix("event: ")
            if line.startswith("data: "):
                data = json.loads(line.removeprefix("data: "))
                names.add(event)
                rows += len(data["rows"]) if event == "rows" else 0
            if names == {"status", "rows"} and rows > 50:
                break
    idle.client.post("/stop")
    assert idle.runner.wait(5.0)


def test_live_rows_of_the_next_trial_are_marked_as_such(idle):
    idle.start("steps", pace="fast", repeats=1)
    assert idle.runner.wait(30.0)
    seen = idle.stranger.get("/live/now").json()["rows"]["last_row"]
    idle.start("steps", pace="real-time", repeats=1)
    time.sleep(0.5)
    rows = idle.stranger.get("/live/now", params={"after_row": seen}).json()["rows"]
    idle.client.post("/stop")
    assert rows["restarted"] is True
    assert rows["rows"][0][rows["channels"].index("time_s")] < 0.02
    later = idle.stranger.get("/live/now", params={"after_row": rows["last_row"]}).json()["rows"]
    assert later["restarted"] is False
    assert idle.runner.wait(5.0)


def test_an_answer_to_what_is_not_asked(idle):
    answer = idle.client.post("/continue", json={"prompt": 1})
    assert answer.status_code == 409
    assert "prompt 1 is not open" in answer.json()["detail"]
    assert idle.stranger.post("/continue", json={"prompt": 1}).status_code == 401


def test_the_person_at_the_bench_is_asked_over_rest(idle, monkeypatch):
    drive = FakeDrive()
    monkeypatch.setattr(station, "make_equipment", lambda _configuration, ask: Equipment(drive, PersonTechnician(ask)))
    idle.start("steps", repeats=1)
    deadline_s = time.monotonic() + 20.0
    while (prompt := idle.client.get("/bench").json()["prompt"]) is None:
        assert time.monotonic() < deadline_s
    assert prompt["sentence"] == "Hang 100 g at the tip of the arm, and stand clear."
    assert drive.exchanges == 0
    assert idle.client.post("/continue", json={"prompt": prompt["number"]}).status_code == 200
    while drive.exchanges == 0:
        assert time.monotonic() < deadline_s
    idle.runner.stop()
    assert idle.runner.wait(10.0)


@pytest.mark.parametrize(
    ("path", "body", "said", "keys"),
    [
        ("/lease", {"duraton_s": 5}, "unknown key; did you mean 'duration_s'?", ["duration_s", "holder", "take_over"]),
        ("/experiments", {"kind": "steps", "paramters": {}}, "did you mean 'parameters'?", None),
        ("/experiments", {"kind": "steps", "parameters": {"repeat": 2}}, "did you mean 'repeats'?", None),
        ("/queue", {"items": [{"kind": "steps", "paramters": {}}]}, "did you mean 'parameters'?", None),
    ],
)
def test_of_an_unknown_key_the_known_ones_are_told(service, path, body, said, keys):
    answer = service.client.post(path, json=body)
    assert answer.status_code == 422
    problem = answer.json()
    assert said in problem["detail"]
    [one] = problem["errors"]
    assert said in one["message"]
    assert one["field"] not in one["allowed"]["keys"]
    if keys is not None:
        assert one["allowed"]["keys"] == keys


def test_of_a_missing_key_no_value_is_shown(service):
    problem = service.client.post("/studies", json={"name": "x"}).json()
    assert problem["detail"] == "experiment_ids: missing; give a value"
    assert problem["errors"][0]["found"] is None
