"""Requests that bring too much: refused before they cost anything, while STOP stays quick."""

import socket
import threading
import time
from urllib.parse import urlsplit

import pytest

from bench.service.http.limits import LONGEST_S, MOST_BYTES, MOST_DEPTH, MOST_DIGITS, check_json
from tests.service.running_service import TOKEN

JSON = {"Content-Type": "application/json"}
STOPPED_WITHIN_S = 0.2


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


def test_a_number_of_too_many_digits_is_refused(idle):
    body = b'{"kind": "steps", "parameters": {"repeats": ' + b"9" * (MOST_DIGITS + 1) + b"}}"
    answer = idle.client.post("/experiments", content=body, headers=JSON)
    assert answer.status_code == 422
    assert "digits" in answer.json()["detail"]


@pytest.mark.parametrize("chunked", [False, True])
def test_a_body_that_is_too_large_is_refused(idle, chunked):
    body = b" " * (MOST_BYTES + 1)
    sent = iter([body[:1000], body[1000:]]) if chunked else body
    answer = idle.client.post("/experiments", content=sent, headers=JSON)
    assert answer.status_code == 413
    assert str(MOST_BYTES) in answer.json()["detail"]


def test_brackets_within_text_do_not_count():
    check_json(b'{"note": "' + b"[" * 1000 + b'\\"", "next": [1]}')


def test_whoever_has_no_token_is_answered_without_his_body_being_read(idle):
    address = urlsplit(idle.url)
    head = "POST /api/v1/experiments HTTP/1.1\r\nHost: localhost\r\nContent-Length: 200000000\r\n\r\n"
    with socket.create_connection((address.hostname, address.port), timeout=5.0) as connection:
        connection.sendall(head.encode())
        assert b"401" in connection.recv(100)


@pytest.mark.wall_clock
@pytest.mark.parametrize("attack", ["large", "deep", "digits", "slow"])
def test_stop_is_quick_under_each_attack(idle, attack):
    address, over = urlsplit(idle.url), threading.Event()
    bodies = {
        "large": b" " * MOST_BYTES,
        "deep": b"[" * MOST_BYTES,
        "digits": b"9" * MOST_BYTES,
        "slow": b"",
    }

    def send() -> None:
        size = len(bodies[attack]) or 1000
        head = (
            "POST /api/v1/experiments HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            f"Authorization: Bearer {TOKEN}\r\nContent-Length: {size}\r\n\r\n"
        )
        while not over.is_set():
            with socket.create_connection((address.hostname, address.port), timeout=LONGEST_S) as connection:
                connection.sendall(head.encode() + bodies[attack])
                if attack == "slow":
                    over.wait(5.0)
                else:
                    connection.recv(1000)

    threads = [threading.Thread(target=send, daemon=True) for _ in range(8)]
    idle.start("steps", pace="real-time", repeats=20)
    for thread in threads:
        thread.start()
    time.sleep(0.5)
    began = time.perf_counter()
    answer = idle.client.post("/stop")
    took_s = time.perf_counter() - began
    over.set()
    for thread in threads:
        thread.join(10.0)
    assert answer.json()["was_running"] is True
    assert took_s <= STOPPED_WITHIN_S
    assert idle.runner.wait(5.0)


def test_what_was_sent_is_not_said_back_whole(idle):
    answer = idle.client.post("/experiments", json={"kind": "x" * 100_000})
    assert answer.status_code == 422
    assert len(answer.text) < 2000


@pytest.mark.parametrize("name", ["from_s", "to_s"])
@pytest.mark.parametrize("value", ["nan", "inf", "-inf"])
def test_a_stretch_has_finite_ends(idle, name, value):
    answer = idle.client.get("/trials/1/samples", params={name: value})
    assert answer.status_code == 422
