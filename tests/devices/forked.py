"""Simulated devices forked from one process that has imported what they need.

Dozens of tests start a device in a process of its own. What that imports and compiles anew takes a second of a
processor, and what it does itself next to nothing. Here it is done once for each process of the tests, when the first
device is asked for, by `python -m tests.devices.forked`: it has one thread only when it forks, and ends with the tests.
"""

import atexit
import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import traceback
from contextlib import suppress
from functools import cache
from typing import IO, NoReturn
from unittest import mock

from tests.devices.turns import no_turns
from tests.paths import ROOT

_PID_BYTES = 8


class ForkedProcess:
    """A process that was forked for us, which its parent waits for.

    Args:
        pid: its number.
        stdout: the end of the pipe that it writes to.
    """

    def __init__(self, pid: int, stdout: IO[str]) -> None:
        self.pid, self.stdout = pid, stdout
        self._is_over = os.pidfd_open(pid)

    def send_signal(self, number: int) -> None:
        with suppress(ProcessLookupError):
            signal.pidfd_send_signal(self._is_over, number)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)

    def wait(self, timeout_s: float) -> bool:
        """Whether it has ended within a time."""
        return bool(select.select([self._is_over], [], [], timeout_s)[0])

    def close(self) -> None:
        """Let go of it; nothing of it is told any more."""
        self.stdout.close()
        os.close(self._is_over)


def forked(*words: str) -> ForkedProcess:
    """Run `friction-bench <words>`; what it complains of goes to where the tests' own complaints go."""
    asked = _server()
    reading, writing = os.pipe()
    try:
        socket.send_fds(asked, [json.dumps(words).encode()], [writing])
        pid = int.from_bytes(asked.recv(_PID_BYTES), "little")
    finally:
        os.close(writing)
    return ForkedProcess(pid, os.fdopen(reading, encoding="utf-8"))


@cache
def _server() -> socket.socket:
    """Where one asks for a device."""
    ours, its = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with its, no_turns():
        words = [sys.executable, "-m", "tests.devices.forked"]
        process = subprocess.Popen(words, stdin=its, stdout=subprocess.DEVNULL, cwd=ROOT)

    def end() -> None:
        ours.close()
        process.wait()

    atexit.register(end)
    return ours


def _warm_up() -> None:
    """Start a device of each kind, and end it: all is imported then, the plant compiled, and no thread left."""
    from bench.cli.operation import simulate_device

    with mock.patch.object(simulate_device, "_serve", lambda simulated, _json: simulated.device.close()):
        for kind in simulate_device._kinds().values():
            simulate_device._command(kind).main(["--json"], standalone_mode=False)
    assert threading.active_count() == 1


def _serve(asking: socket.socket) -> None:
    """Fork a process for each line of words that comes, until nobody is there to ask."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the tests: they end what they have started
    _warm_up()
    while True:
        words, descriptors, _, _ = socket.recv_fds(asking, 1 << 16, 1)
        with suppress(ChildProcessError):  # their time counts as that of the tests
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        if not words:
            return
        pid = os.fork()
        if pid == 0:
            asking.close()
            _become(json.loads(words), descriptors[0])
        asking.send(pid.to_bytes(_PID_BYTES, "little"))
        os.close(descriptors[0])


def _become(words: list[str], stdout: int) -> NoReturn:
    """Be the command of these words, as `python -m bench.cli` is."""
    from bench.cli import main

    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(stdout, 1)
    sys.argv = ["friction-bench", *words]
    try:
        main()
    except SystemExit:
        pass
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(0)  # nothing of what it was forked from is to be tidied up


if __name__ == "__main__":
    _serve(socket.socket(fileno=0))
