"""Errors of studies."""

from collections.abc import Iterator
from contextlib import contextmanager

from bench.errors import BenchError
from compensator.lab.errors import LabError


class StudyError(BenchError, ValueError):
    """Raised when a study cannot be made or answered.

    - no trials, or a hold-out that matches none or all of them
    - experiments of different rigs
    - what the lab says of unusable data or unknown effects
    """


class NothingNewError(StudyError):
    """Raised when a study is to be given more trials, and there is none that it has not yet."""


@contextmanager
def lab_errors() -> Iterator[None]:
    """Turn the lab's errors into the bench's, so that service and command line show them alike."""
    try:
        yield
    except LabError as error:
        raise StudyError(str(error)) from error
