"""One trial from its CSV, read in chunks: memory holds the numbers, and the text of one chunk."""

from collections.abc import Iterator, Sequence
from itertools import islice
from operator import itemgetter

import numpy as np

from bench.recording_set import events as event_cells
from bench.recording_set.columns import Use, plan
from bench.recording_set.mapping import Mapping
from bench.recording_set.numbers import NoNumber, numbers
from bench.recording_set.table import Row, Table, is_blank
from compensator.lab.recording import Event, FloatArray

CHUNK_ROWS = 8192
MOST_ROWS = 50_000_000
FEWEST_ROWS = 2


def read_recording_csv(table: Table, mapping: Mapping) -> tuple[dict[str, FloatArray], list[Event]]:
    """The channels and events of a trial.

    Raises:
        RecordingSetError: unknown columns, ragged lines, text in a number, too few or too many rows,
            a time that is not finite, stands still or runs backwards.
    """
    uses, event_index = plan(table, mapping)
    parts: dict[str, list[FloatArray]] = {use.channel: [] for use in uses}
    found: list[Event] = []
    rows = 0
    for chunk in _chunks(table):
        for use in uses:
            parts[use.channel].append(_column(table, chunk, use, rows, mapping.decimal))
        if event_index is not None:
            found += _events(chunk, event_index, parts["time_s"][-1])
        rows += len(chunk)
    if rows < FEWEST_ROWS:
        raise table.error(f"has {rows} row{'' if rows == 1 else 's'} below the header; wanted at least {FEWEST_ROWS}")
    channels = {channel: np.concatenate(parts.pop(channel)) for channel in list(parts)}
    _check_time(table, channels["time_s"], next(use.source for use in uses if use.channel == "time_s"))
    return channels, found


def _chunks(table: Table) -> Iterator[list[Row]]:
    width = len(table.header)
    total = 0
    with table.rows() as reader:
        while chunk := list(islice(reader, CHUNK_ROWS)):
            if any(len(cells) != width for cells in chunk):
                chunk = [cells for cells in chunk if not is_blank(cells)]
                _check_width(table, chunk, width, total)
            total += len(chunk)
            if total > MOST_ROWS:
                raise table.error(f"has more than {MOST_ROWS} rows; split the trial into several files")
            yield chunk


def _check_width(table: Table, chunk: Sequence[Row], width: int, first_row: int) -> None:
    for index, cells in enumerate(chunk):
        if len(cells) != width:
            message = f"found {len(cells)} cells; wanted {width}, one per column of the header"
            raise table.error(message, first_row + index)


def _column(table: Table, chunk: Sequence[Row], use: Use, first_row: int, decimal: str) -> FloatArray:
    try:
        return use.convert(numbers(list(map(itemgetter(use.index), chunk)), decimal))
    except NoNumber as error:
        wanted = "a number in the unit of the column's name, or nothing where it is not known"
        raise table.error(f"found '{error.text[:40]}'; wanted {wanted}", first_row + error.index, use.source) from None


def _events(chunk: Sequence[Row], index: int, time_s: FloatArray) -> Iterator[Event]:
    for cells, time in zip(chunk, time_s, strict=True):
        if cells[index]:
            yield from event_cells.decode(cells[index], float(time))


def _check_time(table: Table, time_s: FloatArray, column: str) -> None:
    unknown = np.flatnonzero(~np.isfinite(time_s))
    if len(unknown):
        row = int(unknown[0])
        raise table.error(f"found {time_s[row]}; wanted a finite time in every row", row, column)
    wrong = np.flatnonzero(np.diff(time_s) <= 0)
    if len(wrong):
        row = int(wrong[0]) + 1
        before, now = float(time_s[row - 1]), float(time_s[row])
        how = "stands still" if now == before else "runs backwards"
        message = f"time {how}: found {now!r} s after {before!r} s; wanted a time that rises from row to row"
        raise table.error(message, row, column)
