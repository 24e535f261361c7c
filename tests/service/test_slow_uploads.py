"""Uploads that trickle, or that there is no room for: answered in words, and nothing is left of them."""

import errno
import socket
import tempfile
import time
from pathlib import Path
from urllib.parse import urlsplit

import anyio
import pytest

from bench.service.routes import recording_sets
from tests.queue.waiting import wait_for
from tests.service.running_service import TOKEN, RunningService

PATHS = ("/recording-sets?name=x", "/recording-sets/guess?name=x")


@pytest.fixture
def room(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Where uploads are kept meanwhile."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    return tmp_path


def begun(idle: RunningService, path: str) -> socket.socket:
    """A connection on which an upload has begun."""
    found = urlsplit(idle.url)
    head = f"POST /api/v1{path} HTTP/1.1\r\nHost: {found.netloc}\r\nAuthorization: Bearer {TOKEN}\r\n"
    sender = socket.create_connection((found.hostname, found.port), timeout=10.0)
    sender.sendall(f"{head}Content-Type: application/zip\r\nContent-Length: 1000\r\n\r\n".encode())
    return sender


@pytest.mark.parametrize("path", PATHS)
def test_an_upload_that_trickles_is_given_up(idle, monkeypatch, room, path):
    monkeypatch.setattr(recording_sets, "GRACE_S", 0.5, raising=False)
    wanted = b"goes on too slowly; wanted are 1 MB a minute after the first 0.5 s"
    with begun(idle, path) as sender:
        sender.settimeout(0.1)
        answer, kept, end_s = b"", False, time.monotonic() + 10.0
        while wanted not in answer and time.monotonic() < end_s:
            try:
                if not answer:
                    sender.sendall(b"P")
                answer += sender.recv(4096)
            except TimeoutError:
                kept = kept or bool(list(room.iterdir()))
    assert kept
    assert answer.startswith(b"HTTP/1.1 408 ")
    assert wanted in answer
    wait_for(lambda: not list(room.iterdir()))


def test_an_upload_that_breaks_off_is_no_fault_of_the_service(idle, room, caplog):
    with begun(idle, PATHS[0]):
        wait_for(lambda: list(room.iterdir()))
    wait_for(lambda: not list(room.iterdir()))
    idle.client.get("/bench")
    assert "Traceback" not in caplog.text


def test_an_upload_that_comes_as_fast_as_wanted_may_take_long(idle, monkeypatch):
    monkeypatch.setattr(recording_sets, "GRACE_S", 0.3)
    monkeypatch.setattr(recording_sets, "LEAST_B_S", 1000.0)

    def slowly():
        for _ in range(10):
            time.sleep(0.1)
            yield b"P" * 200

    headers = {"Content-Type": "application/zip"}
    answer = idle.client.post(PATHS[0], content=slowly(), headers=headers)
    assert (answer.status_code, "is no zip" in answer.text) == (422, True)


@pytest.mark.parametrize("path", PATHS)
def test_an_upload_without_room_is_told_so(idle, monkeypatch, room, path):
    async def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(anyio.AsyncFile, "write", full)
    answer = idle.client.post(path, content=b"PK", headers={"Content-Type": "application/zip"})
    assert answer.status_code == 503
    assert f"there is no room for the upload in {room} of the service" in answer.json()["detail"]
    assert not list(room.iterdir())
