"""CSV as lines and cells: encoding, header, quotes, and the line that a row stands in."""

import csv
import io
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice

from bench.recording_set.container import Container, Files
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.text.dialect import BLANKS, DELIMITERS, Dialect, dialect_of, dialect_of_text, is_comment
from bench.recording_set.text.encoding import UTF_8, encoding_of, name_of

CHUNK_CHARACTERS = 2**20
LONGEST_RECORD = 64 * CHUNK_CHARACTERS
HEAD_BYTES = 2**16  # from which the dialect is told
LONGEST_NAME, SHOWN_OF_NAME = 500, 20  # characters of a column
SI_TIME = "time_s"  # a header with it is one of a recording set, and needs no guess
Row = list[str]
_QUOTED_COMMA = re.compile(r'"[+-]?\d+,\d+"')


@dataclass(frozen=True)
class Chunk:
    """A part of a table: whole records.

    Attributes:
        place: the file as its user knows it.
        first_line: the line of the file in which it begins, from 1.
        text: as it stands in the file.
        header: of the table; lines that repeat it are left out, and so are remarks.
    """

    place: str
    delimiter: str
    first_line: int
    text: str
    header: tuple[str, ...] = ()

    def records(self, width: int) -> list[tuple[int, Row]]:
        """The line in which each record ends, and its cells; blank lines are left out.

        Raises:
            RecordingSetError: a record that has not `width` cells, or quotes that do not match.
        """
        found = []
        for line, cells in self._records():
            while len(cells) > width and not cells[-1].strip():
                cells.pop()  # a sign at the end of each line
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
        if self.delimiter == BLANKS:
            for number, line in enumerate(self.text.splitlines()):
                if line.strip() and not self._is_remark(line.split()):
                    yield self.first_line + number, line.split()
            return
        reader = csv.reader(io.StringIO(self.text, newline=""), delimiter=self.delimiter, strict=True)
        try:
            for cells in reader:
                if cells and (len(cells) > 1 or cells[0].strip()) and not self._is_remark(cells):
                    yield self.first_line + reader.line_num - 1, cells
        except csv.Error as error:
            message = f"{error}; wanted cells between '{self.delimiter}', and text with such signs in double quotes"
            raise RecordingSetError(self.place, message, self.first_line + max(reader.line_num, 1) - 1) from error

    def _is_remark(self, cells: Row) -> bool:
        """Whether a record is a remark or the header again. In a column of events any text is an event."""
        if not self.header or self.header[0] == "event":
            return False
        return is_comment(cells[0], self.delimiter) or [cell.strip() for cell in cells] == list(self.header)


class Table:
    """A text file with a header, read from front to end.

    Args:
        container: where the file is.
        file: its name in the set.
        delimiter, decimal, encoding: told by the file where None.
        numeric: its lines are numbers, for the most part; a preface may stand above the header then.

    Attributes:
        rate_hz: what the preface says of the sampling; None where it says nothing.
        told: what was told by the file, in words, and is not as a recording set has it; "" where nothing is.

    Raises:
        RecordingSetError: empty, no text, or a header with a column twice or without a name.
    """

    def __init__(
        self,
        container: Container,
        file: str,
        delimiter: str | None = None,
        decimal: str | None = None,
        encoding: str | None = None,
        numeric: bool = True,
    ) -> None:
        self.place = place(container, file)
        self._container = container
        self._file = file
        with container.open(file) as binary:
            head = binary.read(HEAD_BYTES)
        self._encoding = encoding or self._told_encoding(head)
        lines = head.decode(self._encoding, errors="replace").splitlines()
        lines = lines[:-1] if len(head) == HEAD_BYTES else lines  # cut off
        self.dialect = self._dialect(lines, delimiter, decimal, numeric)
        with self._text() as text:
            self.header = list(self.dialect.header) or self._plain_header(text)
        self.header_line = max(self.dialect.header_line, 1)
        self.rate_hz = self.dialect.rate_hz
        self._check_header(numeric, lines[0] if lines else "")
        self.told = self._told(delimiter, decimal, encoding)

    def _dialect(self, lines: list[str], delimiter: str | None, decimal: str | None, numeric: bool) -> Dialect:
        plain = Dialect(delimiter or ",", decimal or ".")
        cells = [cell.strip() for cell in (lines[0] if lines else "").split(plain.delimiter)]
        quoted_commas = any(_QUOTED_COMMA.search(line) for line in lines[1:3])
        if SI_TIME in cells and (decimal is not None or (plain.delimiter == "," and not quoted_commas)):
            return plain
        if not numeric:
            return dialect_of_text(lines, delimiter, decimal)
        return dialect_of(lines, delimiter, decimal) or plain

    def _plain_header(self, text: io.TextIOWrapper) -> list[str]:
        line = ""
        for _ in range(self.dialect.header_line):
            line = text.readline()
        header = Chunk(self.place, self.dialect.delimiter, self.dialect.header_line, line)
        names = [name.strip() for _, cells in header._records() for name in cells]
        return names[:-1] if len(names) > 1 and not names[-1] else names  # a sign at the end of each line

    def _told(self, delimiter: str | None, decimal: str | None, encoding: str | None) -> str:
        names = {"\t": "tabs", BLANKS: "blanks"}
        found = []
        if delimiter is None and self.dialect.delimiter != ",":
            found.append(f"columns between {names.get(self.dialect.delimiter, repr(self.dialect.delimiter))}")
        if decimal is None and self.dialect.decimal != ".":
            found.append("decimal comma")
        if self.dialect.header_line != 1:
            found.append(f"header in line {self.dialect.header_line}" if self.dialect.header_line else "no header")
        if encoding is None and self._encoding != UTF_8:
            found.append(name_of(self._encoding))
        return ", ".join(found)

    def chunks(self, characters: int = CHUNK_CHARACTERS) -> Iterator[Chunk]:
        """What stands below the header, in chunks of about so many characters.

        Raises:
            RecordingSetError: not UTF-8, or a record without end.
        """
        line, begun = self.dialect.first_line, ""
        with self._text() as text:
            for _ in range(line - 1):
                text.readline()
            while more := text.read(characters):
                begun += more
                whole = begun[: begun.rfind("\n") + 1]
                if whole and whole.count('"') % 2 == 0:  # else a quoted cell goes on in the next lines
                    yield self._chunk(line, whole)
                    line += whole.count("\n")
                    begun = begun[len(whole) :]
                elif len(begun) > LONGEST_RECORD:
                    raise self.error("a line or a quoted cell has no end; is a double quote missing?", line)
        if begun:
            yield self._chunk(line, begun)

    def _chunk(self, line: int, text: str) -> Chunk:
        return Chunk(self.place, self.dialect.delimiter, line, text, tuple(self.header))

    def error(self, message: str, line: int | None = None, column: str | None = None) -> RecordingSetError:
        """An error that names the file."""
        return RecordingSetError(self.place, message, line, column)

    @contextmanager
    def _text(self) -> Iterator[io.TextIOWrapper]:
        with self._container.open(self._file) as binary, io.TextIOWrapper(binary, self._encoding, newline="") as text:
            try:
                yield text
            except UnicodeDecodeError as error:
                raise self._encoding_error() from error

    def _told_encoding(self, head: bytes) -> str:
        found = encoding_of(head)
        if found is None:
            raise self.error(
                "is no text; save the table as CSV, or name it by its format: .mat, .npz, .h5, .parquet, .jsonl"
            )
        return found

    def _encoding_error(self) -> RecordingSetError:
        if self._encoding != UTF_8:
            return self.error(f"is not {name_of(self._encoding)} throughout; save the file as CSV UTF-8")
        with self._container.open(self._file) as binary:
            for number, line in enumerate(binary, start=1):
                try:
                    line.decode("utf-8")
                except UnicodeDecodeError as error:
                    found = f"found byte 0x{line[error.start]:02X}, which is not UTF-8"
                    return self.error(f"{found}; save the file as CSV UTF-8", number)
        return self.error("is not UTF-8; save the file as CSV UTF-8")

    def _check_header(self, numeric: bool, first: str) -> None:
        if not any(self.header):
            raise self.error("the file or its first line is empty; wanted a header of column names")
        if len(self.header) == 1 and first.startswith('"') and any(sign in self.header[0] for sign in DELIMITERS[:4]):
            message = "the whole line stands in double quotes, as one cell; take these quotes away, from every line"
            raise self.error(message, self.header_line)
        if numeric:  # pandas leaves the index of a table without a name
            self.header = [name or f"column {number}" for number, name in enumerate(self.header, start=1)]
        seen: set[str] = set()
        for position, name in enumerate(self.header):
            if len(name) > LONGEST_NAME:
                message = f"has a name of {len(name)} characters that begins with '{name[:SHOWN_OF_NAME]}'; at most "
                raise self.error(f"{message}{LONGEST_NAME} are read. Give it a short one", self.header_line)
            if not name:
                raise self.error(f"column {position + 1} has no name; give it one, or remove it", self.header_line)
            if name in seen:
                raise self.error("is there twice; remove one of the two", self.header_line, name)
            seen.add(name)


def quoted(cell: str) -> str:
    """A cell as it stands in a file. (Python's own writer leaves a carriage return bare, which then ends the line.)"""
    if any(sign in cell for sign in ',"\r\n'):
        return '"' + cell.replace('"', '""') + '"'
    return cell


def place(container: Container, file: str) -> str:
    """A file of a set as its user knows it: of files that were named one by one, its own name."""
    alone = isinstance(container, Files) or container.path.name in ("", file)
    return file if alone else f"{container.path.name}/{file}"
