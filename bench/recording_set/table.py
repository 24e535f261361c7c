"""CSV as text: encoding, quotes, and the line that a row stands in."""

import csv
import io
from _csv import Reader
from collections.abc import Iterator
from contextlib import contextmanager

from bench.recording_set.container import Container
from bench.recording_set.errors import RecordingSetError

Row = list[str]


class Table:
    """A CSV with a header, read once from front to end.

    Args:
        container: where the file is.
        file: its name in the set.
        delimiter: between columns.

    Raises:
        RecordingSetError: empty, or a header with a column twice or without a name.
    """

    def __init__(self, container: Container, file: str, delimiter: str = ",") -> None:
        self.place = place(container, file)
        self._container = container
        self._file = file
        self._delimiter = delimiter
        with self._reader() as reader:
            self.header = [name.strip() for name in next(reader, [])]
        self._check_header()

    @contextmanager
    def rows(self) -> Iterator[Reader]:
        """The lines below the header, blank ones too, cells as text; `line_num` is the line read last."""
        with self._reader() as reader:
            next(reader)
            yield reader

    def line_of(self, row: int) -> int:
        """The line in which a row ends; rows are counted from 0 below the header, without blank lines.

        Reads the file again: for messages only.
        """
        with self._reader() as reader:
            next(reader)
            for count, _ in enumerate(cells for cells in reader if not is_blank(cells)):
                if count == row:
                    return reader.line_num
        raise IndexError(row)

    def error(self, message: str, row: int | None = None, column: str | None = None) -> RecordingSetError:
        """An error that names the file, and the line of a row."""
        return RecordingSetError(self.place, message, None if row is None else self.line_of(row), column)

    @contextmanager
    def _reader(self) -> Iterator[Reader]:
        with self._container.open(self._file) as binary:
            text = io.TextIOWrapper(binary, encoding="utf-8-sig", newline="")
            reader = csv.reader(text, delimiter=self._delimiter, strict=True)
            try:
                yield reader
            except UnicodeDecodeError as error:
                raise self._encoding_error() from error
            except csv.Error as error:
                message = (
                    f"{error}; wanted cells between '{self._delimiter}', text with such signs in \"double quotes\""
                )
                raise RecordingSetError(self.place, message, reader.line_num) from error

    def _encoding_error(self) -> RecordingSetError:
        with self._container.open(self._file) as binary:
            for number, line in enumerate(binary, start=1):
                try:
                    line.decode("utf-8")
                except UnicodeDecodeError as error:
                    found = line[error.start]
                    message = f"found byte 0x{found:02X}, which is not UTF-8; save the file as CSV UTF-8"
                    return RecordingSetError(self.place, message, number)
        return RecordingSetError(self.place, "is not UTF-8; save the file as CSV UTF-8")

    def _check_header(self) -> None:
        if not any(self.header):
            raise RecordingSetError(
                self.place, "the file is empty or its first line is; wanted a header of column names"
            )
        for position, name in enumerate(self.header):
            if not name:
                message = f"column {position + 1} has no name; give it one, or remove it"
                raise RecordingSetError(self.place, message, 1)
            if name in self.header[:position]:
                raise RecordingSetError(self.place, "is there twice; remove one of the two", 1, name)


def place(container: Container, file: str) -> str:
    """A file of a set as its user knows it."""
    return file if container.path.name == file else f"{container.path.name}/{file}"


def is_blank(cells: Row) -> bool:
    """Whether a line holds nothing."""
    return not cells or (len(cells) == 1 and not cells[0].strip())
