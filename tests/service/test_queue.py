"""The queue and campaigns over REST."""

from collections.abc import Iterator

import pytest

from tests.queue.waiting import wait_for
from tests.service.running_service import RunningService

STEPS = {"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"}
SLOW = {"kind": "steps", "parameters": {"repeats": 3}, "pace": "real-time"}
CAMPAIGN = {
    "name": "loads",
    "kind": "coast-down",
    "parameters": {"speeds_rad_s": [1.0]},
    "grid": {"load_kg": [0.0, 0.05], "released": ["current", "off"]},
    "order": "boustrophedon",
    "tags": ["winter"],
    "pace": "fast",
}


@pytest.fixture
def queue(idle: RunningService) -> Iterator[RunningService]:
    """The service with an empty queue that goes on."""
    idle.client.delete("/queue")
    idle.client.post("/queue/resume")
    yield idle
    idle.client.delete("/queue")
    idle.client.post("/stop")
    wait_for(lambda: state(idle)["running"] is None)


def state(service: RunningService) -> dict:
    return service.stranger.get("/queue").json()


def add(service: RunningService, *items: dict) -> list[int]:
    answer = service.client.post("/queue", json={"items": list(items)})
    assert answer.status_code == 201, answer.text
    return answer.json()["item_ids"]


def test_items_are_run_and_say_what_became_of_them(queue):
    ids = add(queue, {**STEPS, "tags": ["b", "a"], "operator": "Ada", "note": "first"}, STEPS)
    wait_for(lambda: state(queue)["state"] == "idle")
    ended = {item["item_id"]: item for item in state(queue)["ended"]}
    assert [ended[item_id]["state"] for item_id in ids] == ["completed", "completed"]
    experiment = queue.client.get(f"/experiments/{ended[ids[0]]['experiment_id']}").json()
    assert (experiment["tags"], experiment["operator"], experiment["note"]) == (["a", "b"], "Ada", "first")
    assert queue.client.get(f"/queue/{ids[1]}").json()["state"] == "completed"


def test_one_that_would_be_refused_refuses_all(queue):
    answer = queue.client.post("/queue", json={"items": [STEPS, {"kind": "steps", "parameters": {"load_kg": 5}}]})
    assert answer.status_code == 422
    assert "load_kg is 5 kg; allowed is at most 0.1 kg" in answer.json()["detail"]
    assert state(queue)["waiting"] == []


def test_stop_holds_the_queue_and_resume_goes_on(queue):
    add(queue, SLOW, STEPS)
    wait_for(lambda: state(queue)["running"] is not None and len(queue.runner.live().rows) > 5)
    queue.client.post("/stop", json={"reason": "cable is caught"})
    wait_for(lambda: state(queue)["state"] == "held")
    found = state(queue)
    assert found["reason"] == "cable is caught"
    assert [item["kind"] for item in found["waiting"]] == ["steps"]
    assert found["ended"][0]["state"] == "stopped"
    assert queue.client.post("/queue/resume").status_code == 200
    wait_for(lambda: state(queue)["state"] == "idle")


def test_pause_between_trials_and_time_left(queue):
    before = queue.runner.live().last_row
    add(queue, SLOW)
    wait_for(lambda: len(queue.runner.live(before).rows) > 5)
    assert queue.client.post("/queue/pause").json()["state"] == "pausing"
    wait_for(lambda: state(queue)["state"] == "paused")
    run = queue.stranger.get("/bench").json()["run"]
    assert run["pausing"] == "paused"
    assert 0.0 < run["left_s"] < run["duration_s"]
    assert 0.0 < state(queue)["left_s"] < state(queue)["duration_s"]
    assert state(queue)["reason"].startswith("paused by ")


def test_arranged_while_it_is_held(queue):
    queue.client.post("/queue/pause")
    first, second = add(queue, STEPS, STEPS)
    assert queue.client.patch(f"/queue/{second}", json={"position": 0, "note": "new"}).json()["note"] == "new"
    assert [item["item_id"] for item in state(queue)["waiting"]] == [second, first]
    assert queue.client.delete(f"/queue/{first}").status_code == 204
    assert queue.client.delete(f"/queue/{first}").status_code == 404
    assert queue.client.delete("/queue").json() == {"removed": 1}
    assert queue.client.patch(f"/queue/{second}", json={"position": 0}).status_code == 404


def test_a_campaign_is_planned_then_started(queue):
    plan = queue.client.post("/campaigns/plan", json=CAMPAIGN)
    assert plan.status_code == 200, plan.text
    assert [(item["parameters"]["load_kg"], item["parameters"]["released"]) for item in plan.json()["items"]] == [
        (0.0, "current"),
        (0.0, "off"),
        (0.05, "off"),
        (0.05, "current"),
    ]
    assert plan.json()["load_changes"] == 2
    assert state(queue)["waiting"] == []
    started = queue.client.post("/campaigns", json=CAMPAIGN).json()
    assert started["duration_s"] == plan.json()["duration_s"]
    wait_for(lambda: state(queue)["state"] == "idle")
    found = [queue.client.get(f"/queue/{item_id}").json() for item_id in started["item_ids"]]
    assert {item["state"] for item in found} == {"completed"}
    assert len({item["campaign_id"] for item in found}) == 1
    tagged = queue.stranger.get("/experiments", params={"tag": "winter"}).json()["items"]
    assert sorted(item["experiment_id"] for item in found) == sorted(one["experiment_id"] for one in tagged)


@pytest.mark.parametrize(
    ("method", "path", "body", "status"),
    [
        ("POST", "/queue", {"items": []}, 422),
        ("POST", "/queue", {"items": [{"kind": "dance"}]}, 404),
        ("POST", "/queue", {"items": [{**STEPS, "tags": [""]}]}, 422),
        ("PATCH", "/queue/999999", {"position": 0}, 404),
        ("PATCH", "/queue/1", {"position": -1}, 422),
        ("GET", "/queue/999999", None, 404),
        ("POST", "/campaigns", {"name": "x", "kind": "steps", "grid": {"load_kg": [5.0]}}, 422),
        ("POST", "/campaigns/plan", {"name": "x", "kind": "steps", "grid": {"load_kg": []}}, 422),
        ("PATCH", "/experiments/999999", {"tags": []}, 404),
    ],
)
def test_bad_requests_are_problems(queue, method, path, body, status):
    answer = queue.client.request(method, path, json=body)
    assert answer.status_code == status
    assert answer.headers["content-type"] == "application/problem+json"
    assert answer.json()["detail"]


def test_changes_need_a_token(queue):
    for method, path in (
        ("POST", "/queue"),
        ("DELETE", "/queue"),
        ("POST", "/queue/pause"),
        ("POST", "/queue/resume"),
        ("POST", "/campaigns"),
        ("PATCH", "/experiments/1"),
    ):
        assert queue.stranger.request(method, path, json={}).status_code == 401, (method, path)


def test_the_queue_is_for_who_has_the_bench_and_pausing_for_everybody(queue):
    with queue.with_token("queue-ada", "operator") as ada:
        ada.post("/lease", json={"duration_s": 60})
        assert queue.client.post("/queue", json={"items": [STEPS]}).status_code == 409
        assert queue.client.post("/queue/resume").status_code == 409
        assert queue.client.post("/queue/pause").status_code == 200
        assert ada.post("/queue/resume").status_code == 200
        ada.delete("/lease")


def test_tags_and_note_are_changed_afterwards(queue):
    found = queue.run("steps", repeats=1)
    path = f"/experiments/{found['experiment_id']}"
    changed = queue.client.patch(path, json={"tags": ["new grease", "a", "a"]}).json()
    assert (changed["tags"], changed["note"]) == (["a", "new grease"], found["note"])
    changed = queue.client.patch(path, json={"note": "loose screw"}).json()
    assert (changed["tags"], changed["note"]) == (["a", "new grease"], "loose screw")
    listed = queue.stranger.get("/experiments", params={"tag": "new grease"}).json()["items"]
    assert [one["experiment_id"] for one in listed] == [found["experiment_id"]]
    assert queue.client.patch(path, json={"tags": []}).json()["tags"] == []


def test_a_queue_comes_in_pages_and_is_told_as_a_whole(queue):
    queue.client.post("/queue/pause").raise_for_status()
    ids = add(queue, STEPS, STEPS, STEPS)
    whole = state(queue)
    assert ([one["item_id"] for one in whole["waiting"]], whole["waiting_count"], whole["next_offset"]) == (
        ids,
        3,
        None,
    )
    page = queue.stranger.get("/queue", params={"limit": 2}).json()
    assert ([one["item_id"] for one in page["waiting"]], page["waiting_count"], page["next_offset"]) == (ids[:2], 3, 2)
    assert page["duration_s"] == whole["duration_s"]
    last = queue.stranger.get("/queue", params={"limit": 2, "offset": 2}).json()
    assert ([one["item_id"] for one in last["waiting"]], last["next_offset"]) == (ids[2:], None)


def test_a_full_queue_takes_no_more_by_any_way(queue, monkeypatch):
    monkeypatch.setattr("bench.store.tables.queue.MOST_WAITING", 3)
    queue.client.post("/queue/pause").raise_for_status()
    ids = add(queue, STEPS, STEPS)
    words = (
        "2 experiments wait in the queue, and {} more would be too many; allowed are 3. Let it run on, or remove some"
    )
    for path, body, more in (("/queue", {"items": [STEPS, STEPS]}, 2), ("/campaigns", CAMPAIGN, 4)):
        answer = queue.client.post(path, json=body)
        assert (answer.status_code, answer.json()["detail"]) == (409, words.format(more))
    assert [one["item_id"] for one in state(queue)["waiting"]] == ids
    add(queue, STEPS)
