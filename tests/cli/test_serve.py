"""`friction-bench serve`, `status` and `stop`, in processes of their own."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator

import httpx
import pytest

from bench.service import server
from bench.store import Store
from tests.service.plain_http import NOBODY

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")

PATIENCE_S = 30.0  # for an answer of a process that others keep from running


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        return int(probe.getsockname()[1])


@pytest.fixture
def served(tmp_path) -> Iterator[tuple[subprocess.Popen[str], str, str]]:
    port = free_port()
    words = [sys.executable, "-m", "bench.cli", "--log", "bench.log", "serve", "--port", str(port)]
    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        lines = ""
        assert process.stdout is not None
        while "Ctrl-C" not in lines:
            line = process.stdout.readline()
            assert line, lines
            lines += line
        assert "SIMULATED" in lines
        token = re.search(r"token\s+(\S+)", lines)
        assert token is not None, lines
        yield process, f"http://127.0.0.1:{port}", token[1]
        process.terminate()


def wait_until_answering(url: str) -> None:
    deadline_s = time.monotonic() + PATIENCE_S
    while True:
        try:
            httpx.get(f"{url}/api/v1/bench", timeout=PATIENCE_S, verify=NOBODY)
            return
        except httpx.ConnectError:
            assert time.monotonic() < deadline_s
            time.sleep(0.05)


def start(url: str, token: str) -> None:
    body, headers = {"kind": "steps", "pace": "real-time"}, {"Authorization": f"Bearer {token}"}
    answer = httpx.post(f"{url}/api/v1/experiments", json=body, headers=headers, timeout=PATIENCE_S)
    assert answer.status_code == 201


def test_status_and_stop_from_another_process(served, command, tmp_path, monkeypatch):
    _, url, token = served
    wait_until_answering(url)
    assert json.loads(command("status", "--url", url, "--json").stdout)["state"] == "idle"
    start(url, token)
    assert "running" in command("status", "--url", url).stdout
    stopped = command("stop", "--url", url)  # with the file of the running service in the working directory
    assert stopped.exit_code == 0, stopped.output
    assert "Stop accepted" in stopped.stdout
    [file] = tmp_path.glob("*.token")
    assert token not in file.read_text()
    file.unlink()
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    for store in ((), ("--store", "other.sqlite")):  # another terminal is in another folder, or is about another store
        stopped = command(*store, "stop", "--url", url)
        assert stopped.exit_code == 0, stopped.output
    monkeypatch.setenv("XDG_STATE_HOME", str(elsewhere))  # as of another user
    refused = command("stop", "--url", url)
    assert refused.exit_code == 5
    assert "needs a token" in refused.stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_the_end_of_the_service_stops_the_joint_first(served, tmp_path, number):
    process, url, token = served
    wait_until_answering(url)
    start(url, token)
    time.sleep(0.3)
    with httpx.stream("GET", f"{url}/api/v1/live", timeout=PATIENCE_S) as watching:  # must not hold the service open
        next(watching.iter_lines())
        process.send_signal(number)
        assert process.wait(PATIENCE_S) == 0
    with Store.open(f"sqlite:///{tmp_path / 'friction-bench.sqlite'}") as store:
        [experiment] = store.experiments()
    assert experiment.outcome == "stopped"
    assert "the service was ended" in experiment.reason
    told = {one["event"]: one for one in map(json.loads, (tmp_path / "bench.log").read_text().splitlines())}
    assert (told["request"]["path"], told["request"]["status"]) == ("/api/v1/experiments", 201)
    assert token not in (tmp_path / "bench.log").read_text()
    assert told["run ended"]["outcome"] == "stopped"
    assert told["run ended"]["process"] != told["service started"]["process"] == process.pid
    assert told["service ended"]["level"] == "info"


def test_a_token_file_of_an_earlier_version_goes_on_working(command, tmp_path, monkeypatch):
    file = tmp_path / "friction-bench.token"
    file.write_text("a-token-of-long-ago\n")
    file.chmod(0o600)
    monkeypatch.setattr(server, "_serve", lambda *_: None)
    shown = command("serve", "--port", str(free_port())).stdout
    assert "that of friction-bench.token" in shown
    assert "long-ago" not in shown


def test_the_token_is_shown_once(command, monkeypatch):
    monkeypatch.setattr(server, "_serve", lambda *_: None)
    shown = [command("serve", "--port", str(free_port())).stdout for _ in range(2)]
    assert "it is shown this once" in shown[0]
    assert "was shown at the first start" in shown[1]
    assert "friction-bench --store sqlite:" in " ".join(shown[1].split()), "another store has other tokens"


def test_beyond_loopback_with_a_token_of_the_store(command, monkeypatch):
    monkeypatch.setattr(server, "_serve", lambda *_: None)
    assert command("token", "new", "boss", "--role", "admin").exit_code == 0
    shown = command("serve", "--host", "0.0.0.0", "--plain-http", "--port", str(free_port()))
    assert shown.exit_code == 0, shown.output
    assert "in the clear" in shown.stdout


def test_what_serve_refuses(command, monkeypatch):
    monkeypatch.setattr(server, "_serve", lambda *_: None)  # what is not refused must not be waited for
    beyond = command("serve", "--host", "0.0.0.0")
    assert beyond.exit_code == 3
    assert "FRICTION_BENCH_TOKEN" in beyond.stderr
    assert command("token", "new", "boss", "--role", "admin").exit_code == 0
    clear = command("serve", "--host", "0.0.0.0")
    assert clear.exit_code == 3
    assert "--tls-certificate" in clear.stderr
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        result = command("serve", "--port", port)
    assert result.exit_code == 3
    assert str(port) in result.stderr
