"""A command that runs experiments in its own process, as `friction-bench stop` of the same user finds and stops it.

It shares a stop line with whoever asks, as the bench process of a service does: the control loop looks at it in every
cycle. Once STOP was asked for, no later experiment of the command moves the joint either.
"""

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from bench.control.ending import StopRequest
from bench.own_processes import MOVES_SUFFIX, STOP_SUFFIX, OwnProcess, announced, lives, new_file
from bench.runs.bench_process.stop_line import LineStop, StopLine


class _This:
    """What this process has announced."""

    line: StopLine | None = None
    path: Path | None = None


@contextmanager
def stoppable(what: str, bench: str) -> Iterator[bool]:
    """While it lasts this process is found, and what it runs is stopped. Within another one it changes nothing.

    Args:
        what: the command, "friction-bench run steps".
        bench: name of its bench.

    Returns whether it is found: the user's own folder may be missing, or not writable.
    """
    path = None if _This.line is not None else new_file()
    with ExitStack() as stack:
        if path is not None:
            with suppress(OSError):
                _announce(stack, path, OwnProcess(what, bench, os.getpid()))
        yield _This.line is not None


def _announce(stack: ExitStack, path: Path, told: OwnProcess) -> None:
    stop = path.with_suffix(STOP_SUFFIX)
    stack.callback(stop.unlink, missing_ok=True)
    line = StopLine.make_at(stop)
    stack.enter_context(announced(path, told))
    _This.line, _This.path = line, path
    stack.callback(_forget)


def _forget() -> None:
    _This.line = _This.path = None


def new_stop() -> StopRequest:
    """The stop request of a new experiment of this process."""
    return StopRequest() if _This.line is None else LineStop(_This.line, 0)


@contextmanager
def moving() -> Iterator[None]:
    """While an experiment of this process runs: who has stopped it sees when the joint is off."""
    mark = None if _This.path is None else _This.path.with_suffix(MOVES_SUFFIX)
    if mark is not None:
        with suppress(OSError):
            mark.touch(mode=0o600)
    try:
        yield
    finally:
        if mark is not None:
            with suppress(OSError):
                mark.unlink(missing_ok=True)


def moves(path: Path) -> bool:
    """Whether an experiment runs in the command whose file is at `path`."""
    return path.with_suffix(MOVES_SUFFIX).exists() and lives(path)


def ask_to_stop(path: Path, reason: str) -> None:
    """Have the command stop whose file is at `path`. Waits for nothing.

    Raises:
        OSError: it has just ended.
    """
    StopLine.at(path.with_suffix(STOP_SUFFIX)).ask(reason)
