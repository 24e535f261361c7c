"""Ctrl-C, SIGTERM, SIGHUP and `friction-bench stop` during a run: the joint is stopped, the record is closed.

Then the program ends.
"""

import signal
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import TYPE_CHECKING

from bench.cli.exit_codes import ExitCode
from bench.cli.output import remark
from bench.own_service import own_folder

if TYPE_CHECKING:
    from bench.runs.bench_control import BenchControl

_CODES = {
    signal.SIGINT: ExitCode.INTERRUPTED,
    signal.SIGTERM: ExitCode.TERMINATED,
    signal.SIGHUP: ExitCode.TERMINATED,
}
_NAMES = {
    signal.SIGINT: "Ctrl-C at the terminal",
    signal.SIGTERM: "SIGTERM at the terminal",
    signal.SIGHUP: "the terminal was closed",
}


@contextmanager
def handled_by(handler: Callable[[int, FrameType | None], object], numbers: Iterable[int]) -> Iterator[None]:
    """While it lasts these signals are a function's."""
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, earlier in before.items():
            signal.signal(number, earlier)


def _not_ignored() -> list[signal.Signals]:
    """`nohup` has SIGHUP ignored, and means it."""
    return [number for number in _CODES if signal.getsignal(number) is not signal.SIG_IGN]


@contextmanager
def until_interrupted() -> Iterator[Callable[[], bool]]:
    """While it lasts a signal ends nothing by itself: whoever asks is told that one has come."""
    came: list[int] = []
    with handled_by(lambda number, _frame: came.append(number), _not_ignored()):
        yield lambda: bool(came)


@contextmanager
def stoppable_command(command: str, bench: str) -> Iterator[None]:
    """While it lasts `friction-bench stop` in another terminal stops what this command runs.

    One that carries out several experiments enters it round all of them: a stop between two counts for the next.
    """
    from bench.runs.stoppable import stoppable

    with stoppable(f"friction-bench {command}", bench) as is_found:
        if not is_found:
            remark(
                f"{own_folder() or 'the home folder'} cannot be written: 'friction-bench stop' in another terminal "
                "does not find this command; Ctrl-C here stops it"
            )
        yield


@dataclass
class Received:
    """The exit code of the first signal that came; None without one."""

    exit_code: int | None = None


@contextmanager
def stopping_on_signals(runner: "BenchControl") -> Iterator[Received]:
    """While it lasts a signal stops the joint and raises nothing, so a second Ctrl-C cannot cut off the power-off."""
    received = Received()

    def stop(number: int, _frame: FrameType | None) -> None:
        if received.exit_code is None:
            received.exit_code = _CODES[signal.Signals(number)]
        runner.stop(_NAMES[signal.Signals(number)])

    with handled_by(stop, _not_ignored()):
        yield received
