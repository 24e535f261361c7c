"""Tokens: where they come from, how they are kept, whose they are."""

import os
import stat
import time
from collections import OrderedDict
from datetime import timedelta

import httpx
import pytest

from bench.errors import ConfigurationError
from bench.own_service import own_file, read_token
from bench.service.auth import token_register
from bench.service.auth.attempts import BURST, MOST_ADDRESSES, REFILL_S, Attempts
from bench.service.auth.session import found_token, session_file, session_token
from bench.service.auth.token_register import TokenRegister, first_token, has_valid_token
from bench.service.auth.tokens import (
    Role,
    check_name,
    chosen_token,
    digest_of,
    make_token,
    token_file,
)
from bench.store import Store
from bench.store.tables.experiments import now
from tests.service.running_service import TOKEN


@pytest.fixture
def store(tmp_path):
    with Store.open(f"sqlite:///{tmp_path / 'bench.sqlite'}") as opened:
        yield opened


@pytest.fixture
def forgiven(service, monkeypatch):
    """The service as if no wrong token had ever come."""
    monkeypatch.setattr(service.access.attempts, "_full_at_s", OrderedDict())
    return service


def test_the_first_start_makes_one_token_and_keeps_its_digest_alone(store, tmp_path):
    assert not has_valid_token(store)
    made = first_token(store, None).made
    assert len(made) == 43
    assert first_token(store, None).made is None
    [kept] = store.access.tokens.find()
    assert (kept.name, kept.role, kept.digest) == ("first", "admin", digest_of(made))
    for file in tmp_path.iterdir():
        assert made.encode() not in file.read_bytes(), file


def test_a_token_is_made_again_when_all_are_revoked(store):
    first_token(store, None)
    store.access.tokens.revoke("first")
    assert first_token(store, None).made is not None
    assert [(token.name, token.is_valid(now())) for token in store.access.tokens.find()] == [
        ("first", False),
        ("first-2", True),
    ]


def test_no_token_is_made_where_one_was_chosen(store):
    assert first_token(store, ("environment", TOKEN)).made is None
    assert store.access.tokens.find() == []


def test_whose_token_it_is(store):
    operator, expired, revoked = make_token(), make_token(), make_token()
    store.access.tokens.add("ada", "operator", digest_of(operator))
    store.access.tokens.add("old", "admin", digest_of(expired), now() - timedelta(seconds=1))
    store.access.tokens.add("gone", "admin", digest_of(revoked))
    store.access.tokens.revoke("gone")
    register = TokenRegister({"environment": TOKEN}, store.access.tokens.find)
    assert register.caller(operator) is None
    register.refresh()
    assert (register.caller(operator).name, register.caller(operator).role) == ("ada", Role.OPERATOR)
    assert (register.caller(TOKEN).name, register.caller(TOKEN).role) == ("environment", Role.ADMIN)
    for wrong in (expired, revoked, "", operator[:-1], digest_of(operator)):
        assert register.caller(wrong) is None


def test_every_digest_is_compared_whichever_fits(store, monkeypatch):
    tokens = [make_token() for _ in range(3)]
    for number, token in enumerate(tokens):
        store.access.tokens.add(f"t{number}", "viewer", digest_of(token))
    register = TokenRegister({}, store.access.tokens.find)
    register.refresh()
    compared = []
    monkeypatch.setattr(token_register.hmac, "compare_digest", lambda a, b: compared.append(a) or a == b)
    for token in (*tokens, "wrong"):
        register.caller(token)
    assert len(compared) == 4 * len(tokens)


def test_a_token_opens_at_once_and_closes_within_the_refresh(forgiven):
    with forgiven.with_token("at once", "viewer") as client:
        assert client.get("/token").json() == {"accepted": True, "name": "at once", "role": "viewer"}
        forgiven.store.access.tokens.revoke("at once")
        deadline_s = time.monotonic() + 20.0
        while client.get("/token").status_code != 401:
            assert time.monotonic() < deadline_s
            time.sleep(0.1)


def test_a_token_that_expires_opens_nothing_from_then_on(forgiven):
    with forgiven.with_token("short", "viewer", expires_utc=now() + timedelta(seconds=1)) as client:
        assert client.get("/token").status_code == 200
        time.sleep(1.1)
        assert "has expired" in client.get("/token").json()["detail"]


@pytest.mark.parametrize(
    ("role", "stop", "start", "audit"),
    [("viewer", 200, 403, 403), ("operator", 200, 404, 403), ("admin", 200, 404, 200)],
)
def test_what_each_role_may(forgiven, role, stop, start, audit):
    with forgiven.with_token(f"one {role}", role) as client:
        assert client.post("/stop").status_code == stop
        assert client.post("/experiments", json={"kind": "no such kind"}).status_code == start
        assert client.get("/audit").status_code == audit


def test_a_refused_role_is_told_which_it_takes(forgiven):
    with forgiven.with_token("a visitor", "viewer") as client:
        answer = client.post("/experiments", json={"kind": "steps"})
    assert answer.headers["content-type"] == "application/problem+json"
    assert "'a visitor' has the role viewer; this takes the role operator" in answer.json()["detail"]


def test_wrong_tokens_are_slowed_down_and_right_ones_never(forgiven):
    wrong = {"Authorization": "Bearer wrong-token-0123456789"}
    answers = [httpx.get(f"{forgiven.url}/api/v1/token", headers=wrong) for _ in range(BURST + 2)]
    assert [answer.status_code for answer in answers] == [401] * BURST + [429] * 2
    assert 1 <= int(answers[-1].headers["retry-after"]) <= REFILL_S
    assert answers[-1].headers["content-type"] == "application/problem+json"
    assert forgiven.client.post("/stop").status_code == 200
    with forgiven.with_token("known", "viewer") as client:
        forgiven.access.look_again()
        assert client.post("/stop").status_code == 200


@pytest.mark.parametrize("path", ["/nothing", "/experiments", "/stop"])
def test_a_wrong_token_counts_once_wherever_it_is_sent(forgiven, path):
    wrong = {"Authorization": "Bearer wrong-token-0123456789"}
    refused = 404 if path == "/nothing" else 401
    answers = [httpx.post(f"{forgiven.url}/api/v1{path}", headers=wrong) for _ in range(BURST + 2)]
    assert [answer.status_code for answer in answers] == [refused] * BURST + [429] * 2
    assert 1 <= int(answers[-1].headers["retry-after"]) <= REFILL_S
    assert answers[-1].headers["content-type"] == "application/problem+json"
    assert forgiven.client.post("/stop").status_code == 200


def test_a_waiting_address_is_let_in_again_one_by_one():
    time_s = 100.0
    attempts = Attempts(lambda: time_s)
    for _ in range(BURST):
        assert attempts.wait_s("192.0.2.1") == 0
        attempts.failed("192.0.2.1")
    assert attempts.wait_s("192.0.2.1") == pytest.approx(REFILL_S)
    assert attempts.wait_s("192.0.2.2") == 0
    time_s += REFILL_S
    assert attempts.wait_s("192.0.2.1") == 0
    attempts.failed("192.0.2.1")
    assert attempts.wait_s("192.0.2.1") == pytest.approx(REFILL_S)


def test_addresses_of_one_ipv6_customer_count_as_one_and_memory_is_bounded():
    attempts = Attempts(lambda: 0.0)
    for number in range(BURST):
        attempts.failed(f"2001:db8::{number}")
    assert attempts.wait_s("2001:db8::ffff") > 0
    assert attempts.wait_s("2001:db8:0:1::") == 0
    for number in range(MOST_ADDRESSES + 100):
        attempts.failed(f"host-{number}")
    assert len(attempts._full_at_s) == MOST_ADDRESSES


@pytest.mark.parametrize("name", ["", " x", "a/b", "environment", "this-user", "x" * 65, "new\nline"])
def test_names_that_cannot_be_given(name):
    with pytest.raises(ConfigurationError):
        check_name(name)


def test_a_session_token_lives_as_long_as_its_service(tmp_path):
    path = session_file(f"sqlite:///{tmp_path}/bench.sqlite", 8000)
    assert path == tmp_path / "bench.port-8000.token"
    path.write_text("left by a service that was killed")
    with session_token(path) as token:
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert read_token(path) == token
    assert not path.exists()


def test_a_session_token_is_found_whatever_the_store(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    served, other = (f"sqlite:///{tmp_path}/{name}.sqlite" for name in ("served", "other"))
    own = own_file(8000)
    assert own == tmp_path / "state" / "friction-bench" / "port-8000.token"
    with session_token(session_file(served, 8000), own) as token:
        assert stat.S_IMODE(own.stat().st_mode) == 0o600
        assert stat.S_IMODE(own.parent.stat().st_mode) == 0o700
        assert found_token(served, 8000) == found_token(other, 8000) == token
        assert found_token(other, 8001) is None
        own.chmod(0o644)
        with pytest.raises(ConfigurationError, match="chmod 600"):
            found_token(other, 8000)
    assert not own.exists()
    assert found_token(other, 8000) is None


def test_the_token_of_the_service_that_runs_goes_before_one_that_was_left(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    here, there = (f"sqlite:///{tmp_path}/{name}.sqlite" for name in ("here", "there"))
    left = session_file(here, 8000)
    left.write_text("left-by-a-service-that-was-killed\n")
    left.chmod(0o600)
    os.utime(left, (1.0, 1.0))
    with session_token(session_file(there, 8000), own_file(8000)) as token:
        assert found_token(here, 8000) == token


def test_a_service_does_not_take_away_the_token_of_another_of_its_port(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    paths = [session_file(f"sqlite:///{tmp_path}/{name}.sqlite", 8000) for name in ("first", "second")]
    with session_token(paths[0], own_file(8000)):
        second = session_token(paths[1], own_file(8000))
        token = second.__enter__()
    assert found_token(f"sqlite:///{tmp_path}/none.sqlite", 8000) == token
    second.__exit__(None, None, None)


def test_without_a_folder_of_ones_own_the_file_beside_the_store_has_to_do(tmp_path, monkeypatch):
    (tmp_path / "state").write_text("a file where a folder is wanted")
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    url = f"sqlite:///{tmp_path}/bench.sqlite"
    with session_token(session_file(url, 8000), own_file(8000)) as token:
        assert found_token(url, 8000) == token


def test_a_token_file_that_others_can_read_is_refused(tmp_path, monkeypatch):
    monkeypatch.delenv("FRICTION_BENCH_TOKEN", raising=False)
    path = token_file(f"sqlite:///{tmp_path}/bench.sqlite")
    assert path == tmp_path / "bench.token"
    assert chosen_token(path) is None
    path.write_text(TOKEN + "\n")
    os.chmod(path, 0o600)
    assert chosen_token(path) == ("token-file", TOKEN)
    os.chmod(path, 0o644)
    with pytest.raises(ConfigurationError, match="chmod 600"):
        chosen_token(path)


def test_the_environment_gives_the_token(tmp_path, monkeypatch):
    monkeypatch.setenv("FRICTION_BENCH_TOKEN", "a-token-of-the-lab-2026")
    assert chosen_token(tmp_path / "bench.token") == ("environment", "a-token-of-the-lab-2026")
    monkeypatch.setenv("FRICTION_BENCH_TOKEN", "short")
    with pytest.raises(ConfigurationError, match="has 5 characters"):
        chosen_token(tmp_path / "bench.token")
