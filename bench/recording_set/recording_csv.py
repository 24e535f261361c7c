"""One trial from its CSV, read in chunks: memory holds the numbers, and the text of one chunk."""

from array import array
from collections.abc import Iterator, Sequence

import numpy as np

from bench.recording_set.mapping import Mapping
from bench.recording_set.text import numbers
from bench.recording_set.text.columns import Use, plan
from bench.recording_set.text.table import Chunk, Row, Table
from bench.recording_set.text.values import decode_events
from compensator.lab.recordings.recording import Event, FloatArray

MOST_ROWS = 50_000_000
FEWEST_ROWS = 2


def read_recording_csv(table: Table, mapping: Mapping) -> tuple[dict[str, FloatArray], list[Event]]:
    """The channels and events of a trial.

    Raises:
        RecordingSetError: unknown columns, ragged lines, text in a number, too few or too many rows,
            a time that is not finite, stands still or runs backwards.
    """
    uses, event_index = plan(table, mapping)
    grown = {use.channel: array("d") for use in uses}  # grows in place, where a list of parts would double the memory
    events: list[Event] = []
    time = next(use for use in uses if use.channel == "time_s")
    last_s = -np.inf
    for chunk in table.chunks():
        columns, rows = _read(chunk, len(table.header), uses, event_index, mapping)
        time_s = columns["time_s"]
        _check_time(chunk, last_s, time_s, time.source)
        last_s = time_s[-1] if len(time_s) else last_s
        for use in uses:
            _check_finite(chunk, columns[use.channel], use.source)
        if event_index is not None:
            events += _events(rows, event_index, time_s)
        for channel, values in columns.items():
            grown[channel].frombytes(values.tobytes())
        if len(grown["time_s"]) > MOST_ROWS:
            raise table.error(f"has more than {MOST_ROWS} rows; split the trial into several files")
    count = len(grown["time_s"])
    if count < FEWEST_ROWS:
        found = "1 row" if count == 1 else f"{count} rows"
        raise table.error(f"has {found} below the header; wanted at least {FEWEST_ROWS}")
    return {channel: np.frombuffer(values) for channel, values in grown.items()}, events


def _read(
    chunk: Chunk, width: int, uses: Sequence[Use], event_index: int | None, mapping: Mapping
) -> tuple[dict[str, FloatArray], list[Row]]:
    """The channels of a chunk, and its rows as text where they hold events."""
    if event_index is None or (event_index == width - 1 and chunk.last_is_empty()):
        matrix = numbers.matrix(chunk.text, width, mapping.delimiter, mapping.decimal)
        if matrix is not None:
            return {use.channel: use.convert(matrix[:, use.index]) for use in uses}, []
    rows = [cells for _, cells in chunk.records(width)]
    return {use.channel: _column(chunk, rows, use, mapping.decimal) for use in uses}, rows


def _column(chunk: Chunk, rows: Sequence[Row], use: Use, decimal: str) -> FloatArray:
    try:
        return use.convert(numbers.column([cells[use.index] for cells in rows], decimal))
    except numbers.NoNumber as error:
        wanted = "a number in the unit of the column's name, or nothing where it is not known"
        raise chunk.error(f"found '{error.text[:40]}'; wanted {wanted}", error.index, use.source) from None


def _events(rows: Sequence[Row], index: int, time_s: FloatArray) -> Iterator[Event]:
    for row, cells in enumerate(rows):
        if cells[index]:
            yield from decode_events(cells[index], float(time_s[row]))


def _check_finite(chunk: Chunk, values: FloatArray, column: str) -> None:
    infinite = np.flatnonzero(np.isinf(values))
    if len(infinite):
        row = int(infinite[0])
        raise chunk.error(f"found {values[row]}; wanted a finite number, or nothing where it is not known", row, column)


def _check_time(chunk: Chunk, last_s: float, time_s: FloatArray, column: str) -> None:
    unknown = np.flatnonzero(~np.isfinite(time_s))
    if len(unknown):
        row = int(unknown[0])
        raise chunk.error(f"found {time_s[row]}; wanted a finite time in every row", row, column)
    wrong = np.flatnonzero(np.diff(time_s, prepend=last_s) <= 0)
    if len(wrong):
        row = int(wrong[0])
        before, now = float(time_s[row - 1] if row else last_s), float(time_s[row])
        how = "stands still" if now == before else "runs backwards"
        message = f"time {how}: found {now!r} s after {before!r} s; wanted a time that rises from row to row"
        raise chunk.error(message, row, column)
