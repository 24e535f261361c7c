"""CSV as lines and cells: encoding, header, quotes, and the line that a row stands in."""

import csv
import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice

from bench.recording_set.container import Container
from bench.recording_set.errors import RecordingSetError

CHUNK_CHARACTERS = 2**20
LONGEST_RECORD = 64 * CHUNK_CHARACTERS
Row = list[str]


@dataclass(frozen=True)
class Chunk:
    """A part of a table: whole records.

    Attributes:
        place: the file as its user knows it.
        delimiter: between columns.
        first_line: the line of the file in which it begins, from 1.
        text: as it stands in the file.
    """

    place: str
    delimiter: str
    first_line: int
    text: str

    def records(self, width: int) -> list[tuple[int, Row]]:
        """The line in which each record ends, and its cells; blank lines are left out.

        Raises:
            RecordingSetError: a record that has not `width` cells, or quotes that do not match.
        """
        found = []
        for line, cells in self._records():
            if len(cells) != width:
                raise RecordingSetError(
                    self.place, f"found {len(cells)} cells; wanted {width}, one per column of the header", line
                )
            found.append((line, cells))
        return found

    def line_of(self, row: int) -> int:
        """The line in which a record ends; records are counted from 0, without blank lines."""
        return next(islice(self._records(), row, None))[0]

    def last_is_empty(self) -> bool:
        """Whether every line ends with an empty cell."""
        ends = sum(self.text.count(self.delimiter + end) for end in ("\n", "\r\n"))
        return ends == self.text.count("\n") and self.text.endswith(("\n", self.delimiter))

    def error(self, message: str, row: int, column: str | None = None) -> RecordingSetError:
        """An error that names the file, and the line of a record."""
        return RecordingSetError(self.place, message, self.line_of(row), column)

    def _records(self) -> Iterator[tuple[int, Row]]:
        reader = csv.reader(io.StringIO(self.text, newline=""), delimiter=self.delimiter, strict=True)
        try:
            for cells in reader:
                if cells and (len(cells) > 1 or cells[0].strip()):
                    yield self.first_line + reader.line_num - 1, cells
        except csv.Error as error:
            message = f"{error}; wanted cells between '{self.delimiter}', and text with such signs in double quotes"
            raise RecordingSetError(self.place, message, self.first_line + max(reader.line_num, 1) - 1) from error


class Table:
    """A CSV with a header, read from front to end.

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
        with self._text() as text:
            header = Chunk(self.place, delimiter, 1, text.readline())
            self.header = [name.strip() for _, cells in header._records() for name in cells]
        self._check_header()

    def chunks(self, characters: int = CHUNK_CHARACTERS) -> Iterator[Chunk]:
        """What stands below the header, in chunks of about so many characters.

        Raises:
            RecordingSetError: not UTF-8, or a record without end.
        """
        line, begun = 2, ""
        with self._text() as text:
            text.readline()
            while more := text.read(characters):
                begun += more
                whole = begun[: begun.rfind("\n") + 1]
                if whole and whole.count('"') % 2 == 0:  # else a quoted cell goes on in the next lines
                    yield Chunk(self.place, self._delimiter, line, whole)
                    line += whole.count("\n")
                    begun = begun[len(whole) :]
                elif len(begun) > LONGEST_RECORD:
                    raise self.error("a line or a quoted cell has no end; is a double quote missing?", line)
        if begun:
            yield Chunk(self.place, self._delimiter, line, begun)

    def error(self, message: str, line: int | None = None, column: str | None = None) -> RecordingSetError:
        """An error that names the file."""
        return RecordingSetError(self.place, message, line, column)

    @contextmanager
    def _text(self) -> Iterator[io.TextIOWrapper]:
        with self._container.open(self._file) as binary, io.TextIOWrapper(binary, "utf-8-sig", newline="") as text:
            try:
                yield text
            except UnicodeDecodeError as error:
                raise self._encoding_error() from error

    def _encoding_error(self) -> RecordingSetError:
        with self._container.open(self._file) as binary:
            for number, line in enumerate(binary, start=1):
                try:
                    line.decode("utf-8")
                except UnicodeDecodeError as error:
                    found = f"found byte 0x{line[error.start]:02X}, which is not UTF-8"
                    return self.error(f"{found}; save the file as CSV UTF-8", number)
        return self.error("is not UTF-8; save the file as CSV UTF-8")

    def _check_header(self) -> None:
        if not any(self.header):
            raise self.error("the file or its first line is empty; wanted a header of column names")
        for position, name in enumerate(self.header):
            if not name:
                raise self.error(f"column {position + 1} has no name; give it one, or remove it", 1)
            if name in self.header[:position]:
                raise self.error("is there twice; remove one of the two", 1, name)


def quoted(cell: str) -> str:
    """A cell as it stands in a file. (Python's own writer leaves a carriage return bare, which then ends the line.)"""
    if any(sign in cell for sign in ',"\r\n'):
        return '"' + cell.replace('"', '""') + '"'
    return cell


def place(container: Container, file: str) -> str:
    """A file of a set as its user knows it."""
    return file if container.path.name == file else f"{container.path.name}/{file}"
