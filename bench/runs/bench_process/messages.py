"""What a service and its bench process say to each other, and the version of it.

They are the same software, on one machine, parent and child: messages are pickled, over a socket pair that nobody
else can reach. STOP is no message: it goes by the stop line, past everything here.
"""

import pickle
import traceback
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from bench.config.configuration import BenchConfiguration
from bench.runs.bench_control import RunnerStatus
from bench.runs.live import LiveRows

VERSION = b"friction-bench bench process, 4"
"""First on the line from both ends, as bytes. A service outlives an update of its files: then these differ."""

Method = Literal["begin", "answer", "pause", "resume", "look", "read_drives", "clear_faults"]
"""Of `BenchControl`, called in the bench process; the others a service answers from what it has seen."""


@dataclass(frozen=True, slots=True)
class Hello:
    """The service, first: what bench it is."""

    configuration: BenchConfiguration


@dataclass(frozen=True, slots=True)
class Call:
    """The service: call a method of the runner.

    Attributes:
        stops: how often STOP had been asked for before the call.
    """

    number: int
    method: Method
    arguments: tuple[Any, ...]
    stops: int


@dataclass(frozen=True, slots=True)
class Close:
    """The service, last: stop what runs, close the drive and the store, and end."""


@dataclass(frozen=True, slots=True)
class Accepted:
    """The bench process: a call has come, and is made. One that was not accepted was never begun."""

    number: int


@dataclass(frozen=True, slots=True)
class Reply:
    """The bench process: what a call returned."""

    number: int
    value: Any


@dataclass(frozen=True, slots=True)
class Failure:
    """The bench process: what a call raised.

    Attributes:
        number: of the call; 0: the bench process cannot begin, and ends.
        attributes: of the error; those that can be sent.
        trace: where it was raised, for the log.
    """

    number: int
    kind: type[BaseException]
    text: str
    attributes: Mapping[str, object]
    trace: str


@dataclass(frozen=True, slots=True)
class Seen:
    """The bench process, many times a second while it runs something.

    Attributes:
        busy: whether something runs; it goes on for a moment after the outcome is known.
        rows: recorded since the message before.
    """

    status: RunnerStatus
    busy: bool
    rows: LiveRows


SLOW: tuple[Method, ...] = ("begin", "look", "read_drives", "clear_faults")
"""Methods that wait for a drive or a disk; they take turns, and the others do not wait for them."""


def failure_of(number: int, error: BaseException) -> Failure:
    """An error as it is sent."""
    attributes = {name: value for name, value in vars(error).items() if _can_be_sent(value)}
    kind = type(error) if _can_be_sent(type(error)) else RuntimeError
    trace = "".join(traceback.format_exception(error))
    return Failure(number, kind, str(error), attributes, trace)


def error_of(failure: Failure) -> BaseException:
    """The error again. Its class is not called: those of the drives take more than the text."""
    error: BaseException = failure.kind.__new__(failure.kind, failure.text)
    error.args = (failure.text,)
    vars(error).update(failure.attributes)
    error.add_note(f"raised in the other process:\n{failure.trace}")
    return error


def _can_be_sent(value: object) -> bool:
    try:
        pickle.dumps(value)
    except Exception:  # whatever a class of somebody else's raises: it is left out
        return False
    return True
