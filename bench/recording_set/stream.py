"""A recording that is written piece by piece: from the store without ever being in memory as a whole."""

from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from bench.config.channels import exported
from bench.store import Event, Store, Trial
from compensator.lab.recordings.recording import Condition, FloatArray, Recording

PIECE_ROWS = 8192


@dataclass(frozen=True)
class Piece:
    """Some rows of a recording.

    Attributes:
        columns: shape (channels, rows).
        events: row of the piece -> the events that stand in it.
        time_s: of the rows, shape (rows,).
    """

    columns: FloatArray
    events: dict[int, list[Event]]
    time_s: FloatArray


@dataclass(frozen=True)
class RecordingStream:
    """A recording, read as it is written.

    Attributes:
        trial_id: in the store; None where it comes from elsewhere.
        channels: names, in the order of the columns.
        events: in order of time.
        read: called with the first row and how many; columns of all channels, shape (channels, up to as many).
    """

    name: str
    kind: str
    conditions: Mapping[str, Condition]
    channels: tuple[str, ...]
    rows: int
    events: Sequence[Event]
    read: Callable[[int, int], FloatArray]
    trial_id: int | None = None

    def pieces(self) -> Iterator[Piece]:
        """All rows, in order. An event stands in the first row that is not before it, or in the last row."""
        time = self.channels.index("time_s")
        events = list(self.events)
        for first_row in range(0, self.rows, PIECE_ROWS):
            columns = self.read(first_row, PIECE_ROWS)
            time_s = columns[time]
            last = first_row + PIECE_ROWS >= self.rows
            count = len(events) if last else bisect_right(events, time_s[-1], key=lambda event: event.time_s)
            here, events = events[:count], events[count:]
            yield Piece(columns, _by_row(here, time_s), time_s)


def stream_of(recording: Recording) -> RecordingStream:
    """A recording in memory as a stream."""

    def read(first_row: int, rows: int) -> FloatArray:
        return np.stack([values[first_row : first_row + rows] for values in recording.channels.values()])

    names, events = tuple(recording.channels), sorted(recording.events, key=lambda event: event.time_s)
    return RecordingStream(recording.name, recording.kind, recording.conditions, names, len(recording), events, read)


def stream_of_trial(store: Store, trial: Trial, every_channel: bool = False) -> RecordingStream:
    """A trial of the store as a stream: the rows that it has now. A slow reader holds no transaction open.

    Args:
        store: with the trial.
        trial: which.
        every_channel: those too that no recording set holds.
    """
    channels = tuple(trial.channels) if every_channel else exported(trial.channels)
    columns = [trial.channels.index(name) for name in channels]

    def read(first_row: int, rows: int) -> FloatArray:
        return store.part(trial, first_row, rows)[columns]

    events = store.events(trial.id)
    return RecordingStream(trial.name, trial.kind, dict(trial.conditions), channels, trial.rows, events, read, trial.id)


def _by_row(events: Sequence[Event], time_s: FloatArray) -> dict[int, list[Event]]:
    rows: dict[int, list[Event]] = {}
    for event in events:
        row = min(int(np.searchsorted(time_s, event.time_s)), len(time_s) - 1)
        rows.setdefault(row, []).append(event)
    return rows
