"""Requests that bring too much: refused before they cost anything, while STOP stays quick."""

import socket
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest

from bench.experiments.kinds.waveform import LARGEST_CSV
from bench.service.http.limits import MOST_BYTES, MOST_DEPTH, MOST_DIGITS, MOST_PARTS, MOST_WITH_TEXT, check_json
from tests.devices.turns import HOST, ask_for_turns
from tests.service.attacks import BODIES, STOPPED_WITHIN_S, stopped_under
from tests.service.running_service import TOKEN
from tests.service.served_process import started_process

JSON = {"Content-Type": "application/json"}


def nested(depth: int) -> bytes:
    return b'{"kind": "steps", "parameters": {"load_kg": ' + b"[" * depth + b"]" * depth + b"}}"


@pytest.mark.parametrize("path", ["/experiments", "/queue", "/studies"])
@pytest.mark.parametrize("depth", [MOST_DEPTH - 1, 300, 900, 100_000])
def test_a_body_nested_too_deep_is_refused_and_leaves_nothing(idle, path, depth):
    before = idle.client.get("/experiments").json()["items"]
    answer = idle.client.post(path, content=nested(depth), headers=JSON)
    assert answer.status_code == 422
    assert f"more than {MOST_DEPTH} deep" in answer.json()["detail"]
    assert idle.client.get("/experiments").json()["items"] == before


def test_a_body_of_too_many_lists_is_refused(idle):
    body = b'{"kind": "steps", "parameters": {"repeats": [' + b"[]," * (MOST_PARTS - 2) + b"1]}}"
    answer = idle.client.post("/experiments", content=body, headers=JSON)
    assert answer.status_code == 422
    assert f"{MOST_PARTS + 1} lists and objects; allowed are {MOST_PARTS}" in answer.json()["detail"]


def test_a_number_of_too_many_digits_is_refused(idle):
    body = b'{"kind": "steps", "parameters": {"repeats": ' + b"9" * (MOST_DIGITS + 1) + b"}}"
    answer = idle.client.post("/experiments", content=body, headers=JSON)
    assert answer.status_code == 422
    assert "digits" in answer.json()["detail"]


@pytest.mark.parametrize("chunked", [False, True])
def test_a_body_that_is_too_large_is_refused(idle, chunked):
    for path, most in (("/queue", MOST_BYTES), ("/experiments", MOST_WITH_TEXT)):
        body = b" " * (most + 1)
        sent = iter([body[:1000], body[1000:]]) if chunked else body
        answer = idle.client.post(path, content=sent, headers=JSON)
        assert answer.status_code == 413
        assert f"allowed are {most} bytes" in answer.json()["detail"]


def test_brackets_within_text_do_not_count():
    check_json(b'{"note": "' + b"[" * 1000 + b'\\"", "next": [1]}')


def test_whoever_has_no_token_is_answered_without_his_body_being_read(idle):
    address = urlsplit(idle.url)
    head = "POST /api/v1/experiments HTTP/1.1\r\nHost: localhost\r\nContent-Length: 200000000\r\n\r\n"
    with socket.create_connection((address.hostname, address.port), timeout=5.0) as connection:
        connection.sendall(head.encode())
        assert b"401" in connection.recv(100)


@pytest.fixture(scope="module")
def served(tmp_path_factory) -> Iterator[httpx.Client]:
    """A service in a process of its own: the senders of these tests do not take its interpreter.

    It and its bench have turns, and the senders have none: a machine that is busy with other work is no attack.
    """
    headers = {"Authorization": f"Bearer {TOKEN}"}
    with (
        started_process(tmp_path_factory.mktemp("served")) as (process, url),
        httpx.Client(base_url=f"{url}/api/v1", headers=headers, timeout=60.0) as client,
    ):
        for pid in (process.pid, *children_of(process.pid)):
            ask_for_turns(pid, HOST)
        yield client


def children_of(pid: int) -> list[int]:
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return [int(one) for task in tasks for one in task.read_text().split()]


@pytest.mark.wall_clock
@pytest.mark.parametrize("attack", BODIES)
def test_stop_is_quick_under_each_attack(served, attack):
    assert stopped_under(served, str(served.base_url), attack) <= STOPPED_WITHIN_S


def test_what_was_sent_is_not_said_back_whole(idle):
    answer = idle.client.post("/experiments", json={"kind": "x" * 100_000})
    assert answer.status_code == 422
    assert len(answer.text) < 2000


@pytest.mark.parametrize("name", ["from_s", "to_s"])
@pytest.mark.parametrize("value", ["nan", "inf", "-inf"])
def test_a_stretch_has_finite_ends(idle, name, value):
    answer = idle.client.get("/trials/1/samples", params={name: value})
    assert answer.status_code == 422


def test_a_waveform_is_as_long_as_its_description_says(idle):
    rows = "".join(f"{row * 0.001:.3f},0.0\n" for row in range(25_000))
    body = {"kind": "waveform", "parameters": {"csv": f"t_s,current_a\n{rows}"}}
    assert MOST_BYTES < len(body["parameters"]["csv"]) < LARGEST_CSV
    answer = idle.client.post("/experiments/plan", json=body)
    assert answer.status_code == 200, answer.text
    body["parameters"]["csv"] += "0" * LARGEST_CSV
    answer = idle.client.post("/experiments/plan", json=body)
    assert (answer.status_code, f"at most {LARGEST_CSV} characters" in answer.json()["detail"]) == (422, True)


def test_only_text_may_be_long(idle):
    numbers = b'{"kind": "steps", "parameters": {"repeats": [' + b"1," * MOST_BYTES + b"1]}}"
    answer = idle.client.post("/experiments", content=numbers, headers=JSON)
    assert answer.status_code == 413
    assert f"bytes beside its texts; allowed are {MOST_BYTES}" in answer.json()["detail"]
    answer = idle.client.post("/queue", content=b'{"items": "' + b"x" * MOST_BYTES + b'"}', headers=JSON)
    assert answer.status_code == 413
    assert f"allowed are {MOST_BYTES} bytes" in answer.json()["detail"]
