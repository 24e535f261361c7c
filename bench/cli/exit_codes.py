"""Exit codes, and the one place where errors of ours become a message and a code."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from enum import IntEnum

import typer

from bench.cli.output import complain
from bench.errors import BenchError
from compensator.errors import CompensatorError
from drivers.errors import DriveError


class ExitCode(IntEnum):
    """What the shell sees."""

    DONE = 0
    NOT_COMPLETED = 1
    USAGE = 2
    REFUSED = 3
    DRIVE = 4
    SERVICE = 5
    INTERRUPTED = 130
    TERMINATED = 143


HELP = """\
Exit codes: 0 done; 1 the experiment did not complete (failed, tripped, stopped by somebody); \
2 wrong usage; 3 refused: bad input, outside the limits, no such thing, bench busy; 4 the drive does not answer or has \
a fault; 5 the service cannot be reached or refuses the token; 130 ended by Ctrl-C; 143 ended by SIGTERM.

Environment: FRICTION_BENCH_CONFIG (as --config), FRICTION_BENCH_STORE (as --store), FRICTION_BENCH_LOG (as --log), \
FRICTION_BENCH_URL (as --url: service for `status`, `stop` and `queue`), FRICTION_BENCH_TOKEN (token of the service).
"""


class ServiceError(BenchError, ConnectionError):
    """Raised when the service cannot be reached, refuses the token, or answers with a problem."""


class NoAnswerError(ServiceError):
    """Raised when the service cannot be reached."""


class StatusError(ServiceError):
    """Raised when what is there answers with a problem."""

    def __init__(self, message: str, status: int) -> None:
        super().__init__(message)
        self.status = status


def code_of(error: Exception) -> ExitCode:
    """The exit code of an error of ours."""
    if isinstance(error, DriveError):
        return ExitCode.DRIVE
    return ExitCode.SERVICE if isinstance(error, ServiceError) else ExitCode.REFUSED


@contextmanager
def errors_as_messages(in_full: Callable[[str], str]) -> Iterator[None]:
    """Errors of ours become one message on stderr and an exit code; others are bugs and keep their traceback.

    Args:
        in_full: gives the commands in a message the options that they need.
    """
    try:
        yield
    except (BenchError, DriveError, CompensatorError) as error:
        complain(in_full(str(error)))
        raise typer.Exit(code_of(error)) from error
