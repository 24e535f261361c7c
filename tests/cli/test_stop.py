"""`friction-bench stop` finds every service and every run of this user, and says of each what came of it."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import tomli_w

from bench.config.configuration import default_configuration
from bench.control.late_cycles import BRAKING_S
from bench.own_processes import own_processes
from bench.runs.stoppable import ask_to_stop, moves, new_stop, stoppable
from bench.store import Store
from tests.cli.test_serve import PATIENCE_S, free_port, start, wait_until_answering
from tests.service.test_tls import OPENSSL, make

pytestmark = pytest.mark.skipif(os.name != "posix", reason="locks of POSIX")
STOP_S = 0.2  # to the brake, and then to the end of the record
HOST_S = 0.3  # that a busy machine keeps a process waiting
NOBODY_URL = "http://127.0.0.1:9"  # somebody may serve at the usual address


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch) -> Path:
    """Nobody else's processes are found, and none of these by others."""
    monkeypatch.setattr("bench.cli.operation.stop.DEFAULT_URL", NOBODY_URL)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    return tmp_path / "state" / "friction-bench"


@contextmanager
def program(folder: Path, sign: str, *words: object) -> Iterator[tuple["subprocess.Popen[str]", str]]:
    """A command of ours in a terminal of its own, once it has said `sign`; and what it has said."""
    command = [sys.executable, "-m", "bench.cli", *map(str, words)]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        assert process.stdout is not None
        lines = ""
        while sign not in lines:
            line = process.stdout.readline()
            assert line, lines
            lines += line
        try:
            yield process, lines
        finally:
            process.kill()


@contextmanager
def service(folder: Path, *options: str) -> Iterator[tuple["subprocess.Popen[str]", str, str]]:
    """A service; its address and its token."""
    port = free_port()
    with program(folder, "Ctrl-C", *options, "serve", "--port", port) as (process, lines):
        token = re.search(r"token\s+(\S+)", lines)
        assert token is not None
        url = f"http://127.0.0.1:{port}"
        wait_until_answering(url)
        yield process, url, token[1]


@contextmanager
def moving(folder: Path) -> Iterator["subprocess.Popen[str]"]:
    """`friction-bench run` while rows are recorded."""
    words = ("run", "steps", "--repeats", "4", "--pace", "real-time")
    with program(folder, "trial 1 of 4", *words) as (process, _):
        deadline_s = time.monotonic() + PATIENCE_S
        with Store.open(f"sqlite:///{folder / 'friction-bench.sqlite'}") as store:
            while not any(trial.rows > 20 for trial in store.trials()):
                assert time.monotonic() < deadline_s
                time.sleep(0.02)
        yield process


def ends(folder: Path) -> list[tuple[str, str]]:
    """Outcome and reason of every experiment."""
    with Store.open(f"sqlite:///{folder / 'friction-bench.sqlite'}") as store:
        return [(one.outcome, one.reason) for one in store.experiments()]


def test_a_run_in_another_terminal_is_stopped_beside_an_idle_service(tmp_path, command):
    with service(tmp_path) as (_, url, _), moving(tmp_path) as run:
        stopped = command("stop", "--json")
        assert run.wait(PATIENCE_S) == 1, "stopped by somebody"
        assert stopped.exit_code == 0, stopped.output
        told = {one["who"].split(" (")[0]: one for one in json.loads(stopped.stdout)}
        assert (told[url]["was_running"], told[url]["detail"]) == (False, "Nothing was running on this service.")
        assert told["friction-bench run steps"]["was_running"]
        assert str(run.pid) in told["friction-bench run steps"]["who"]
    [(outcome, reason)] = ends(tmp_path)
    assert outcome == "stopped"
    assert "friction-bench stop" in reason
    with Store.open(f"sqlite:///{tmp_path / 'friction-bench.sqlite'}") as store:
        [trial] = store.trials()
        assert [event.name for event in store.recording(trial.id).events][-1] == "end", "the drive braked, and is off"


def test_a_run_without_any_service_is_stopped(tmp_path, command):
    with moving(tmp_path) as run:
        stopped = command("stop")
        assert stopped.exit_code == 0, stopped.output
        assert f"friction-bench run steps (bench 'paper', process {run.pid}): stopped" in " ".join(
            stopped.stdout.split()
        )
        assert run.wait(PATIENCE_S) == 1
    assert ends(tmp_path)[0][0] == "stopped"


def test_every_service_is_asked_by_address_and_bench(tmp_path, command):
    second = tmp_path / "second"
    second.mkdir()
    values = default_configuration().model_dump(mode="json", exclude_none=True, exclude={"store"})
    (second / "bench.toml").write_text(tomli_w.dumps(values | {"name": "second"}))
    with service(tmp_path) as (_, idle, _), service(second, "--config", "bench.toml") as (_, busy, token):
        start(busy, token)
        shown = " ".join(command("stop").stdout.split())
        assert f"{busy} (bench 'second', process" in shown
        assert "Stop accepted" in shown
        assert f"{idle} (bench 'paper', process" in shown
        assert "the joint is off" not in shown, "of what a service has not asked it says nothing"
        again = command("--store", "other.sqlite", "stop", "--url", idle)
        assert f"{idle}: Nothing was running on this service." in " ".join(again.stdout.split())
        deadline_s = time.monotonic() + PATIENCE_S
        while ends(second)[0][0] == "running" and time.monotonic() < deadline_s:
            time.sleep(0.02)
    assert ends(second)[0][0] == "stopped"


def test_one_that_does_not_answer_is_named(tmp_path, command, monkeypatch):
    monkeypatch.setattr("bench.cli.operation.service.TIMEOUT_S", 0.5)
    with service(tmp_path) as (process, url, _), moving(tmp_path) as run:
        process.send_signal(signal.SIGSTOP)  # it is there, and does nothing
        stopped = command("stop")
        assert stopped.exit_code == 5, stopped.output
        assert f"{url} (bench 'paper', process {process.pid}) WAS NOT STOPPED" in " ".join(stopped.stderr.split())
        assert run.wait(PATIENCE_S) == 1, "the others are stopped all the same"


def test_nothing_to_stop_is_no_success(command):
    stopped = command("stop")
    assert stopped.exit_code == 5
    assert "nothing was stopped" in stopped.stderr


def test_a_killed_process_leaves_nothing_that_is_asked(tmp_path, command, own_folder):
    with moving(tmp_path) as run:
        run.kill()
        run.wait()
    assert len(list(own_folder.glob("process-*"))) == 3
    assert command("stop").exit_code == 5
    assert not list(own_folder.glob("process-*"))


def test_the_word_of_another_user_or_machine_is_left_alone(tmp_path, own_folder, monkeypatch):
    with moving(tmp_path) as run:
        files = sorted(own_folder.glob("process-*"))
        with monkeypatch.context() as other:
            other.setattr("os.geteuid", lambda: os.getuid() + 1)
            assert own_processes() == []
        with monkeypatch.context() as other:
            other.setattr("bench.own_processes._machine", lambda: "elsewhere")
            assert own_processes() == []
        assert sorted(own_folder.glob("process-*")) == files
        assert run.poll() is None


def test_a_stop_between_two_experiments_of_a_command_counts_for_the_next(tmp_path):
    """As between the strokes of `calibrate run`: nothing moves at that moment."""
    with stoppable("friction-bench calibrate run", "bench") as found, stoppable("within", "bench"):
        assert found
        [(path, told)] = own_processes()
        assert told.what == "friction-bench calibrate run"
        before = new_stop()
        assert not before.is_set()
        assert not moves(path)
        ask_to_stop(path, "cable is caught")
        assert before.is_set()
        after = new_stop()
        assert after.is_set()
        assert after.reason == "cable is caught"
    assert own_processes() == []
    assert not new_stop().is_set()


def test_without_a_folder_of_the_user_a_run_says_that_it_is_not_found(tmp_path, command, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    ran = command("run", "steps", "--repeats", "1")
    assert ran.exit_code == 0, ran.output
    assert "does not find this command" in ran.stderr


def test_a_run_is_off_soon_after_a_stop(tmp_path):
    with moving(tmp_path) as run:
        [(path, _)] = own_processes()
        asked_s = time.monotonic()
        ask_to_stop(path, "cable is caught")
        while moves(path):
            time.sleep(0.001)
        took_s = time.monotonic() - asked_s
        assert run.wait(PATIENCE_S) == 1
    assert took_s < BRAKING_S + STOP_S + HOST_S


@pytest.mark.skipif(OPENSSL is None, reason="needs openssl")
def test_of_a_service_with_a_certificate_of_any_name(tmp_path, command):
    made, port = make(tmp_path, "bench.lab"), free_port()
    words = ("serve", "--port", port, "--host", "localhost", "--tls-certificate", made.chain, "--tls-key", made.key)
    with program(tmp_path, "Ctrl-C", *words):
        stopped = command("stop")
        assert stopped.exit_code == 0, stopped.output
        assert f"https://localhost:{port} (bench 'paper'" in " ".join(stopped.stdout.split())
