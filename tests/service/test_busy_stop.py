"""STOP waits for nothing that others ask for."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from urllib.parse import urlsplit

import httpx
import pytest
from fastapi import FastAPI

from bench.runs.bench_control import BenchControl
from bench.runs.live import LiveRows
from bench.service.http import turns
from bench.service.live import live_events
from bench.service.live.status import Rows, rows_of
from bench.service.stops import LATE
from bench.store.tables.start_keys import StartKeys
from tests.service import running_service as service_of_tests
from tests.service.plain_http import NOBODY
from tests.service.running_service import TOKEN, RunningService, running_service

CLIENTS = 40
ANSWERED_WITHIN_S = 0.25  # a few turns of the interpreter; forty threads of 5 ms each make it over a second


def is_on_a_loop() -> bool:
    """Whether this is the thread of an event loop."""
    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True


class Busy:
    """What routes of the test do until it is over."""

    def __init__(self) -> None:
        self.over = threading.Event()
        self.begun = threading.Semaphore(0)

    def compute(self) -> None:
        self.begun.release()
        while not self.over.is_set():
            pass

    def wait(self, _prompt_number: int = 1) -> None:
        self.begun.release()
        self.over.wait(30.0)


@contextmanager
def asked(service: RunningService, request: str, times: int) -> Iterator[None]:
    """Send a request many times, and read no answer."""
    address = urlsplit(service.url)
    with ExitStack() as sockets:
        for _ in range(times):
            client = sockets.enter_context(socket.create_connection((address.hostname, address.port)))
            client.sendall(request.replace("\n", "\r\n").encode())
        yield


def stopped_after_s(service: RunningService) -> float:
    """As a client sees it that has no connection yet."""
    headers = {"Authorization": f"Bearer {TOKEN}"}
    with httpx.Client(base_url=f"{service.url}/api/v1", headers=headers, timeout=30, verify=NOBODY) as client:
        begun_s = time.monotonic()
        assert client.post("/stop").status_code == 200
        return time.monotonic() - begun_s


@pytest.fixture
def busy() -> Iterator[Busy]:
    found = Busy()
    yield found
    found.over.set()


@pytest.mark.wall_clock
def test_stop_does_not_wait_for_forty_clients_who_ask_for_what_takes_long(tmp_path, busy, monkeypatch) -> None:
    make = service_of_tests.create_app

    def with_one_more_route(*words: object) -> FastAPI:
        app = make(*words)  # type: ignore[arg-type]
        app.get("/long")(lambda: busy.compute())
        return app

    monkeypatch.setattr(service_of_tests, "create_app", with_one_more_route)
    with (
        running_service(tmp_path) as service,
        asked(service, "GET /long HTTP/1.1\nHost: localhost\n\n", CLIENTS),
    ):
        busy.begun.acquire()
        time.sleep(0.2)  # all who may are at it
        waits_s = sorted(stopped_after_s(service) for _ in range(5))
        busy.over.set()
    assert waits_s[2] < ANSWERED_WITHIN_S


def test_stop_does_not_wait_for_an_answer_to_a_prompt_that_the_bench_is_slow_to_take(tmp_path, busy, monkeypatch):
    with running_service(tmp_path) as service:
        runner: BenchControl = service.runner
        monkeypatch.setattr(runner, "answer", busy.wait)
        body = '{"prompt": 1}'
        head = f"POST /api/v1/continue HTTP/1.1\nHost: localhost\nAuthorization: Bearer {TOKEN}\n"
        kind = f"Content-Type: application/json\nContent-Length: {len(body)}\n\n{body}"
        with asked(service, head + kind, 1):
            busy.begun.acquire()
            assert stopped_after_s(service) < 10.0  # the bench takes 30 s
            busy.over.set()


def test_nobody_stands_behind_starts_that_wait_for_their_drive(tmp_path, busy, monkeypatch) -> None:
    with running_service(tmp_path) as service:
        monkeypatch.setattr(service.runner, "start", lambda *_words: busy.wait() or 1)
        body = '{"kind": "steps"}'
        head = f"POST /api/v1/experiments HTTP/1.1\nHost: localhost\nAuthorization: Bearer {TOKEN}\n"
        kind = f"Content-Type: application/json\nContent-Length: {len(body)}\n\n{body}"
        with asked(service, head + kind, turns.MOST_HANDLERS + 1):
            for _ in range(turns.MOST_HANDLERS):
                busy.begun.acquire()
            begun_s = time.monotonic()
            assert service.stranger.get("/trials").status_code == 200
            assert time.monotonic() - begun_s < 10.0  # the drives take 30 s
            busy.over.set()


STEPS = {"kind": "steps", "parameters": {"repeats": 5}, "pace": "real-time"}


def test_a_start_that_waits_for_the_store_begins_nothing_after_a_stop(idle, monkeypatch):
    begun, on, claim = threading.Event(), threading.Event(), StartKeys.claim

    def waiting(*words):
        begun.set()
        assert on.wait(30.0)
        return claim(*words)

    monkeypatch.setattr(StartKeys, "claim", waiting)
    headers = {"Idempotency-Key": "before-the-stop"}
    with ThreadPoolExecutor(1) as pool:
        start = pool.submit(idle.client.post, "/experiments", json=STEPS, headers=headers)
        assert begun.wait(10.0)
        assert idle.client.post("/stop").json()["was_running"] is False
        on.set()
        answer = start.result(30.0)
    assert (answer.status_code, "STOP" in answer.json()["detail"]) == (409, True)
    assert idle.runner.status().outcome != "running"
    idle.client.post("/experiments", json=STEPS, headers=headers).raise_for_status()  # the key is free again


def test_what_begins_beside_a_stop_is_stopped(idle, monkeypatch):
    start, runner = idle.runner.start, idle.runner

    def starting(*words):
        with monkeypatch.context() as moment, ThreadPoolExecutor(1) as pool:
            moment.setattr(runner, "stop", lambda *_: None)  # just before the runner begins to listen for this run
            pool.submit(idle.client.post, "/stop").result(10.0)
        return start(*words)

    monkeypatch.setattr(runner, "start", starting)
    idle.client.post("/experiments", json=STEPS).raise_for_status()
    assert runner.wait(10.0)
    assert runner.status().reason.endswith(LATE)


def test_many_rows_for_a_listener_are_not_written_on_the_event_loop(idle, monkeypatch):
    """Listeners that come back all at once, each with twenty thousand rows to hear, would hold up STOP for seconds."""
    idle.start("steps", repeats=3)
    assert idle.runner.wait(60.0)
    written: dict[bool, int] = {True: 0, False: 0}

    def noted(found: LiveRows) -> Rows:
        on_loop = is_on_a_loop()
        written[on_loop] = max(written[on_loop], len(found.rows))
        return rows_of(found)

    monkeypatch.setattr(live_events, "rows_of", noted)
    with idle.stranger.stream("GET", "/live", params={"limit": 20_000}) as stream:
        next(line for line in stream.iter_lines() if line.startswith("event: rows"))
    assert written[False] > live_events.FEW_ROWS
    assert written[True] <= live_events.FEW_ROWS
