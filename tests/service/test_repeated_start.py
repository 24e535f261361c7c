"""A start that is sent twice moves the joint once."""

from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta

import pytest

from bench.service.repeated_start import KeyInUseError, KeyReusedError, once
from bench.store import Store, start_keys
from bench.store.experiments import now

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


@pytest.mark.parametrize("key", ["", "a b", "ü".encode(), "x" * 201])
def test_keys_that_cannot_be_used(idle, key):
    assert idle.client.post("/experiments", json=BODY, headers={"Idempotency-Key": key}).status_code == 422


@pytest.fixture
def store(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


def test_of_many_at_once_one_starts(store):
    started = []

    def start() -> int:
        started.append(1)
        return 7

    def ask(_number: int) -> int | None:
        try:
            return once(store.access.start_keys, "ada", "key", {}, start)
        except KeyInUseError:
            return None

    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(ask, range(16)))
    assert len(started) == 1
    assert set(found) <= {7, None}


def test_a_start_without_an_answer_is_not_begun_again(store):
    store.access.start_keys.claim("ada", "key", "digest of a service that was killed")
    with pytest.raises(KeyReusedError):
        once(store.access.start_keys, "ada", "key", {}, lambda: pytest.fail("it started"))


def test_keys_are_kept_for_a_day(store, monkeypatch):
    assert once(store.access.start_keys, "ada", "key", {}, lambda: 7) == 7
    assert once(store.access.start_keys, "ada", "key", {}, lambda: 8) == 7
    monkeypatch.setattr(start_keys, "now", lambda: now() + timedelta(hours=25))
    assert once(store.access.start_keys, "ada", "key", {}, lambda: 9) == 9
