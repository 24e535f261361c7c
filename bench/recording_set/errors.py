"""Errors of recording sets."""

from collections.abc import Iterator
from contextlib import contextmanager

from bench.errors import BenchError


class RecordingSetError(BenchError, ValueError):
    """Raised when a recording set cannot be read or written; nothing of it is kept then.

    - a folder, zip or file that is missing, damaged, too large or leads out of the set
    - a table with unknown, doubled or missing columns, ragged lines, or text where a number belongs
    - a time that stands still or runs backwards, a trial of one row, a wrong count of rows
    - a rig or mapping with unknown keys or impossible values

    Args:
        file: the file as its user knows it.
        message: what was found, what is wanted, and what to do next.
        line: line in the file, from 1.
        column: name of the column.
    """

    def __init__(self, file: str, message: str, line: int | None = None, column: str | None = None) -> None:
        place = file
        if line is not None:
            place += f", line {line}"
        if column is not None:
            place += f", column '{column}'"
        super().__init__(f"{place}: {message}")
        self.file = file
        self.line = line
        self.column = column


@contextmanager
def needed(place: str, package: str, extra: str, otherwise: str) -> Iterator[None]:
    """Around the import of a package that is not installed with ours.

    Args:
        place: what cannot be read or written without it.
        package: its name.
        extra: of ours that installs it.
        otherwise: what to do without it.

    Raises:
        RecordingSetError: it is not installed.
    """
    try:
        yield
    except ImportError as error:
        how = f"install it with: pip install 'friction-bench[{extra}]', or {otherwise}"
        raise RecordingSetError(place, f"needs {package}; {how}") from error
