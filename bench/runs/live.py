"""The latest rows of the running trial, for who watches: kept in memory, next to the store."""

import threading
from dataclasses import dataclass

import numpy as np

from compensator.lab.recordings.recording import FloatArray


@dataclass(frozen=True, slots=True)
class LiveRows:
    """Rows recorded since a row already known.

    Attributes:
        channels: names of the columns.
        rows: shape (n, channels).
        last_row: number of the newest row, to be asked from next time; rows are numbered on and on.
        restarted: rows before these belong to another trial, or were left out.
        trial_id: the trial in the store; None where that is not known.
        trial_rows: rows of the trial up to the newest.
    """

    channels: tuple[str, ...]
    rows: FloatArray
    last_row: int
    restarted: bool
    trial_id: int | None = None
    trial_rows: int = 0


class LiveBuffer:
    """Written by the recorder's thread, read by anybody.

    Args:
        channels: names of the columns.
        capacity: rows kept, at least.
    """

    def __init__(self, channels: tuple[str, ...], capacity: int = 20_000) -> None:
        self._channels = channels
        self._capacity = capacity
        self._lock = threading.Lock()
        self._blocks: list[FloatArray] = []
        self._first_row = 0  # number of the first row kept
        self._trial_row = 0  # number of the first row of the trial
        self._trial_id: int | None = None
        self._rows_before = 0
        self._kept = 0

    def begin_trial(
        self, channels: tuple[str, ...] | None = None, trial_id: int | None = None, rows_before: int = 0
    ) -> None:
        """Forget the rows of the trial before; rows of other channels may come.

        Args:
            channels: names of the columns; None: as before.
            trial_id: the trial in the store; None where that is not known.
            rows_before: rows of it that come not here.
        """
        with self._lock:
            self._channels = channels or self._channels
            self._first_row += self._kept
            self._trial_row = self._first_row
            self._trial_id, self._rows_before = trial_id, rows_before
            self._kept = 0
            self._blocks.clear()

    def append(self, rows: FloatArray) -> None:
        """Keep rows of shape (n, channels); the oldest go."""
        with self._lock:
            self._blocks.append(rows)
            self._kept += len(rows)
            while self._kept - len(self._blocks[0]) >= self._capacity:
                gone = len(self._blocks.pop(0))
                self._kept -= gone
                self._first_row += gone

    def since(self, after_row: int, limit: int) -> LiveRows:
        """Rows after the one of a number; where there are more than `limit`, the newest.

        Args:
            after_row: `last_row` of the answer before; -1 at first.
            limit: most rows returned, at least 1.
        """
        with self._lock:
            last_row = self._first_row + self._kept - 1
            first_row = max(self._first_row, last_row + 1 - max(limit, 1))
            left_out = after_row < first_row - 1 or after_row > last_row
            restarted = left_out or 0 <= after_row < self._trial_row
            begin = first_row if restarted else after_row + 1
            wanted = last_row + 1 - begin
            blocks, channels = self._newest(wanted), self._channels
            trial_id, trial_rows = self._trial_id, last_row + 1 - self._trial_row + self._rows_before
        rows = np.concatenate(blocks)[-wanted:] if wanted else np.empty((0, len(channels)))
        return LiveRows(channels, rows, last_row, restarted, trial_id, trial_rows)

    def _newest(self, wanted: int) -> list[FloatArray]:
        """The last blocks that hold at least that many rows."""
        found: list[FloatArray] = []
        for block in reversed(self._blocks):
            if wanted <= 0:
                break
            found.insert(0, block)
            wanted -= len(block)
        return found
