"""One trial from its CSV, read in chunks: memory holds the numbers, and the text of one chunk."""

import re
from array import array
from itertools import islice

import numpy as np

from bench.recording_set.conversion import Converted, Raw, channels_of
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import Mapping
from bench.recording_set.text import numbers
from bench.recording_set.text.columns import TIME, plan
from bench.recording_set.text.table import Chunk, Table
from bench.recording_set.text.values import decode_events
from compensator.lab.recordings.recording import EVENT_COLUMN, Event, FloatArray

MOST_ROWS = 50_000_000
FEWEST_ROWS = 2
MOSTLY = 0.5  # of what stands in a column: one that holds so much text is one of text
GROUPED = re.compile(r"[+-]?\d{1,3}([.,' ]\d{3})+([.,]\d*)?")


def read_recording_csv(table: Table, mapping: Mapping) -> tuple[Converted, list[Event]]:
    """The channels, conditions and events of a trial.

    Raises:
        RecordingSetError: unknown columns, ragged lines, text in a number, too few or too many rows,
            a time that is not finite, stands still or runs backwards.
    """
    wanted = plan(table, mapping)
    reader = _Reader(table, wanted.numbers, wanted.texts, wanted.events)
    raw = reader.raw()
    converted = channels_of(raw, wanted, mapping)
    channels, order = converted.channels, converted.order
    events: list[Event] = []
    for sample, row in enumerate(range(len(raw)) if order is None else order.tolist()):
        if row in reader.events:
            events += decode_events(reader.events[row], float(channels[TIME][sample]))
    return converted, events


def read_columns(table: Table) -> dict[str, FloatArray | list[str]]:
    """Every column of a table, as numbers where it holds numbers alone, else as text.

    Raises:
        RecordingSetError: ragged lines, too many rows.
    """
    text = _text_columns(table)
    raw = _Reader(table, [name for name in table.header if name not in text], text, None).raw()
    return {name: raw.numbers[name] if name in raw.numbers else raw.texts[name] for name in table.header}


def _text_columns(table: Table) -> list[str]:
    """Columns in which most of what stands is text, and events; any other word is a fault among numbers."""
    width, decimal = len(table.header), table.dialect.decimal
    texts, filled = np.zeros(width), np.zeros(width)
    for chunk in table.chunks():
        matrix = numbers.matrix(chunk.text, width, chunk.delimiter, decimal)
        if matrix is not None:
            filled += np.isfinite(matrix).sum(axis=0)
            continue
        for _, cells in chunk.records(width):
            filled += [bool(cell.strip()) for cell in cells]
            texts += [not numbers.is_number(cell, decimal) for cell in cells]
    mostly = texts > MOSTLY * filled
    return [name for name, text in zip(table.header, mostly, strict=True) if name == EVENT_COLUMN or text]


class _Reader:
    """Reads the wanted columns of a table, chunk by chunk.

    Attributes:
        events: row -> cell of the column of events, where it holds any.
    """

    def __init__(self, table: Table, wanted: list[str], texts: list[str], events: str | None) -> None:
        self._table = table
        self._width, self._decimal = len(table.header), table.dialect.decimal
        self._at = {name: table.header.index(name) for name in (*wanted, *texts)}
        self._events_at = None if events is None else table.header.index(events)
        # grows in place, where a list of parts would double the memory
        self._numbers = {name: array("d") for name in wanted}
        self._texts: dict[str, list[str]] = {name: [] for name in texts}
        self._rows = 0
        self.events: dict[int, str] = {}

    def raw(self) -> Raw:
        """All rows of the table."""
        for chunk in self._table.chunks():
            self._read(chunk)
            if self._rows > MOST_ROWS:
                raise self._table.error(f"has more than {MOST_ROWS} rows; split the trial into several files")
        if self._rows < FEWEST_ROWS:
            found = "1 row" if self._rows == 1 else f"{self._rows} rows"
            raise self._table.error(f"has {found} below the header; wanted at least {FEWEST_ROWS}")
        return Raw({name: np.frombuffer(values) for name, values in self._numbers.items()}, self._texts, self._error)

    def _read(self, chunk: Chunk) -> None:
        plain = self._events_at is None or (self._events_at == self._width - 1 and chunk.last_is_empty())
        if plain and not self._texts:
            matrix = numbers.matrix(chunk.text, self._width, chunk.delimiter, self._decimal)
            if matrix is not None:
                for name, values in self._numbers.items():
                    values.frombytes(matrix[:, self._at[name]].tobytes())
                self._rows += len(matrix)
                return
        rows = [cells for _, cells in chunk.records(self._width)]
        for name, values in self._numbers.items():
            values.frombytes(self._column(chunk, [cells[self._at[name]] for cells in rows], name).tobytes())
        for name, texts in self._texts.items():
            texts += [cells[self._at[name]] for cells in rows]
        if self._events_at is not None:
            cells_of = ((self._rows + row, cells[self._events_at]) for row, cells in enumerate(rows))
            self.events |= {row: cell for row, cell in cells_of if cell}
        self._rows += len(rows)

    def _column(self, chunk: Chunk, cells: list[str], name: str) -> FloatArray:
        try:
            return numbers.column(cells, self._decimal)
        except numbers.NoNumber as error:
            wanted = "a number in the unit of the column's name, or nothing where it is not known"
            if GROUPED.fullmatch(error.text.strip()):
                wanted = "a number without a sign between its thousands; export the file anew without them"
            raise chunk.error(f"found '{error.text[:40]}'; wanted {wanted}", error.index, name) from None

    def _error(self, message: str, row: int, column: str) -> RecordingSetError:
        """An error in a row of the whole table: its line is looked for only now."""
        lines = (line for chunk in self._table.chunks() for line, _ in chunk.records(self._width))
        return self._table.error(message, next(islice(lines, row, None), None), column)
