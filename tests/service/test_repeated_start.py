"""A start that is sent twice moves the joint once."""

from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta

import pytest

from bench.service.http.repeated_start import KeyInUseError, KeyReusedError, once
from bench.service.routes.experiments import Started
from bench.store import Store
from bench.store.tables import start_keys
from bench.store.tables.experiments import now

BODY = {"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"}


def count(service) -> int:
    return service.store.experiments(limit=1)[0].id


def test_the_same_key_and_body_get_the_same_answer(idle):
    headers = {"Idempotency-Key": "first-sweep"}
    first = idle.client.post("/experiments", json=BODY, headers=headers)
    assert first.status_code == 201
    again = idle.client.post("/experiments", json=BODY, headers=headers)
    assert idle.runner.wait(60.0)
    later = idle.client.post("/experiments", json=BODY, headers=headers)
    for answer in (again, later):
        assert (answer.status_code, answer.json()) == (201, first.json())
        assert answer.headers["location"] == first.headers["location"]
    assert count(idle) == first.json()["experiment_id"]


def test_another_body_is_refused(idle):
    headers = {"Idempotency-Key": "second-sweep"}
    assert idle.client.post("/experiments", json=BODY, headers=headers).status_code == 201
    assert idle.runner.wait(60.0)
    before = count(idle)
    answer = idle.client.post("/experiments", json=BODY | {"note": "other"}, headers=headers)
    assert answer.status_code == 422
    assert "'second-sweep' was used within 24 h with another body" in answer.json()["detail"]
    assert count(idle) == before


def test_a_refused_start_may_be_sent_again(idle):
    headers = {"Idempotency-Key": "third-sweep"}
    assert idle.client.post("/experiments", json={"kind": "no-such-kind"}, headers=headers).status_code == 404
    assert idle.client.post("/experiments", json=BODY, headers=headers).status_code == 201
    assert idle.runner.wait(60.0)


def test_keys_of_different_tokens_do_not_meet(idle):
    headers = {"Idempotency-Key": "fourth-sweep"}
    first = idle.client.post("/experiments", json=BODY, headers=headers).json()
    assert idle.runner.wait(60.0)
    with idle.with_token("somebody else", "operator") as other:
        assert other.post("/experiments", json=BODY, headers=headers).json() != first
    assert idle.runner.wait(60.0)


STEPS_ITEM = {"kind": "steps", "parameters": {"repeats": 1}, "pace": "fast"}
LOADS = {"name": "loads", "kind": "steps", "parameters": {"repeats": 1}, "grid": {"load_kg": [0.0, 0.05]}}


@pytest.fixture
def held(idle):
    """The service with an empty queue that is held."""
    idle.client.post("/queue/pause")
    idle.client.delete("/queue")
    yield idle
    idle.client.delete("/queue")
    idle.client.post("/queue/resume")


@pytest.mark.parametrize(
    ("path", "body", "other"),
    [
        ("/queue", {"items": [STEPS_ITEM]}, {"items": [STEPS_ITEM] * 2}),
        ("/campaigns", LOADS, LOADS | {"note": "other"}),
    ],
)
def test_what_goes_into_the_queue_goes_in_once(held, path, body, other):
    headers = {"Idempotency-Key": f"a-key-of{path}"}
    first = held.client.post(path, json=body, headers=headers)
    assert first.status_code == 201
    again = held.client.post(path, json=body, headers=headers)
    assert (again.status_code, again.json()) == (201, first.json())
    waiting = [item["item_id"] for item in held.client.get("/queue").json()["waiting"]]
    assert waiting == first.json()["item_ids"]
    assert held.client.post(path, json=other, headers=headers).status_code == 422
    assert [item["item_id"] for item in held.client.get("/queue").json()["waiting"]] == waiting


def test_a_key_of_another_route_is_refused(held):
    headers = {"Idempotency-Key": "one-key-for-two-routes"}
    assert held.client.post("/queue", json={"items": [STEPS_ITEM]}, headers=headers).status_code == 201
    assert held.client.post("/campaigns", json=LOADS, headers=headers).status_code == 422


@pytest.mark.parametrize("key", ["", "a b", "ü".encode(), "x" * 201])
def test_keys_that_cannot_be_used(idle, key):
    assert idle.client.post("/experiments", json=BODY, headers={"Idempotency-Key": key}).status_code == 422


SEVEN, EIGHT = Started(experiment_id=7, kind="steps"), Started(experiment_id=8, kind="steps")


@pytest.fixture
def store(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


def test_of_many_at_once_one_starts(store):
    started = []

    def start() -> Started:
        started.append(1)
        return SEVEN

    def ask(_number: int) -> Started | None:
        try:
            return once(store.access.start_keys, "ada", "key", {}, start, Started)
        except KeyInUseError:
            return None

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(ask, range(16)))
    assert len(started) == 1
    assert SEVEN in found
    assert all(one in (None, SEVEN) for one in found)


def test_a_start_without_an_answer_is_not_begun_again(store):
    store.access.start_keys.claim("ada", "key", "digest of a service that was killed")
    with pytest.raises(KeyReusedError):
        once(store.access.start_keys, "ada", "key", {}, lambda: pytest.fail("it started"), Started)


def test_keys_are_kept_for_a_day(store, monkeypatch):
    assert once(store.access.start_keys, "ada", "key", {}, lambda: SEVEN, Started) == SEVEN
    assert once(store.access.start_keys, "ada", "key", {}, lambda: EIGHT, Started) == SEVEN
    monkeypatch.setattr(start_keys, "now", lambda: now() + timedelta(hours=25))
    assert once(store.access.start_keys, "ada", "key", {}, lambda: EIGHT, Started) == EIGHT
