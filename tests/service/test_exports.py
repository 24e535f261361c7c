"""Exports that take long, or that nobody reads: others do not wait for them, and few are kept."""

import socket
import tempfile
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest

import bench.recording_set
from bench.service.http import exports
from tests.queue.waiting import wait_for
from tests.service.running_service import RunningService

AT_ONCE = 6


@pytest.fixture
def address(idle: RunningService, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr(exports, "MOST_AT_ONCE", AT_ONCE, raising=False)
    return f"/experiments/{idle.run('steps', repeats=1)['experiment_id']}/recording-set"


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[list[Path], threading.Event]]:
    """Exports that have begun, and what lets them go on."""
    begun: list[Path] = []
    go_on = threading.Event()

    def waiting(_store: object, _number: int, path: Path) -> None:
        begun.append(path)
        go_on.wait(30.0)
        path.write_bytes(b"zip")

    monkeypatch.setattr(bench.recording_set, "export_experiment", waiting)
    yield begun, go_on
    go_on.set()


def test_readers_do_not_stand_behind_slow_exports_and_too_many_are_refused(idle, address, slow):
    begun, go_on = slow
    with ThreadPoolExecutor(AT_ONCE + 2) as pool:
        asked = [pool.submit(httpx.get, f"{idle.url}/api/v1{address}", timeout=60) for _ in range(AT_ONCE + 2)]
        wait_for(lambda: len(begun) >= 2)
        assert idle.stranger.get("/trials", timeout=5.0).status_code == 200
        wait_for(lambda: sum(one.done() for one in asked) == 2)
        answer = idle.stranger.get(address, timeout=5.0)
        assert answer.headers["Retry-After"] == "30"
        assert (
            f"{AT_ONCE} exports are under way and not read to the end; allowed are {AT_ONCE}" in answer.json()["detail"]
        )
        known = idle.stranger.get(address, headers={"If-None-Match": "*"}, timeout=5.0)
        assert known.status_code == 304  # what is not sent is no export
        go_on.set()
        assert sorted(one.result().status_code for one in asked) == [200] * AT_ONCE + [503] * 2
    wait_for(lambda: not any(path.parent.exists() for path in begun))
    assert idle.stranger.get(address, timeout=30.0).status_code == 200


def test_an_export_that_nobody_reads_gives_its_place_and_its_copy_back(idle, address, monkeypatch, tmp_path):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(
        bench.recording_set, "export_experiment", lambda _store, _number, path: path.write_bytes(bytes(30_000_000))
    )
    held = [_unread(idle, address) for _ in range(AT_ONCE)]
    wait_for(lambda: len(list(tmp_path.iterdir())) == AT_ONCE)
    assert idle.stranger.get(address).status_code == 503
    assert len(list(tmp_path.iterdir())) == AT_ONCE
    for one in held:
        one.close()
    wait_for(lambda: not list(tmp_path.iterdir()))
    assert len(idle.stranger.get(address).content) == 30_000_000


def _unread(service: RunningService, address: str) -> socket.socket:
    found = urlsplit(service.url)
    asked = socket.create_connection((found.hostname, found.port))
    asked.sendall(f"GET /api/v1{address} HTTP/1.1\r\nHost: {found.netloc}\r\n\r\n".encode())
    return asked
