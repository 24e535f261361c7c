"""Ctrl-C and SIGTERM during a run: the joint is stopped, the record is closed, then the program ends."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING

from bench.cli.exit_codes import ExitCode

if TYPE_CHECKING:
    from bench.runner import Runner

_CODES = {signal.SIGINT: ExitCode.INTERRUPTED, signal.SIGTERM: ExitCode.TERMINATED}
_NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "SIGTERM"}


@dataclass
class Received:
    """The exit code of the first signal that came; None without one."""

    exit_code: int | None = None


@contextmanager
def stopping_on_signals(runner: "Runner") -> Iterator[Received]:
    """While it lasts a signal stops the joint and raises nothing, so a second Ctrl-C cannot cut off the power-off."""
    received = Received()

    def stop(number: int, _frame: FrameType | None) -> None:
        if received.exit_code is None:
            received.exit_code = _CODES[signal.Signals(number)]
        runner.stop(f"{_NAMES[signal.Signals(number)]} at the terminal")

    before = {number: signal.signal(number, stop) for number in _CODES}
    try:
        yield received
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
