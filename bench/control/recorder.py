"""Takes the rows of a running trial to its sink, on a thread of its own: a paced loop never waits for a disk."""

import queue
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from struct import Struct
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from bench.errors import RecordingError

Row = tuple[float, ...]
Rows = NDArray[np.float64]
Event = tuple[float, str, str]


class Sink(Protocol):
    """Where rows and events go. Called from one thread, in order; every call returns when its data are committed."""

    def append(self, rows: Rows, events: Sequence[Event] = ()) -> None:
        """Commit rows of shape (n, number of channels), and what happened while they came; either may be none."""


class RowBuffer:
    """Rows of one length, packed as they come: half the work of an array made of tuples later."""

    def __init__(self, width: int, rows: int) -> None:
        self._width, self._more = width, rows
        self._room = self._filled = 0
        row = Struct(f"{width}d")
        self._size, self._pack = row.size, row.pack_into
        self._memory = bytearray()

    def append(self, row: Row) -> int:
        """Take one row; return how many there are."""
        filled = self._filled
        if filled == self._room:
            self._room += self._more
            self._memory.extend(bytes(self._more * self._size))
        self._pack(self._memory, filled * self._size, *row)
        self._filled = filled = filled + 1
        return filled

    def rows(self) -> Rows:
        """A copy of all rows, shape (n, values in a row)."""
        values = np.frombuffer(self._memory, count=self._filled * self._width)
        return values.reshape(self._filled, self._width).copy()

    def clear(self) -> None:
        """Forget the rows."""
        self._filled = 0


class Recorder:
    """Gathers rows and events into blocks and hands them over.

    A killed process loses the block in hand, `BLOCK_S` at most. A block is one transaction of the store, events and
    all: a search has thirty events, and a transaction of their own would cost each as much as a hundred cycles.

    Args:
        sink: where they go.
        channels: values in a row.
        patience_s: how long a full backlog is waited for. None at all where the loop moves a real joint: it has limits
            and STOP to look at. A simulation is faster than any disk, and waits.
    """

    BLOCK_S = 0.04  # of wall time: what is not committed cannot be seen, and a plot is watched at 20 updates a second
    BLOCK_ROWS = 4000
    BACKLOG = 256  # blocks that may wait for a sink that goes on, slowly
    STALL_S = 6.4  # how long a sink may be at one block while a real joint moves: a locked database, a failing disk
    LAST_PATIENCE_S = 60.0  # how long the end is waited for: the joint is off by then, and the rows are worth it

    def __init__(self, sink: Sink, channels: int, patience_s: float = 0.0) -> None:
        self.error: BaseException | None = None
        self._sink = sink
        self._patience_s = patience_s
        self._rows = RowBuffer(channels, self.BLOCK_ROWS)
        self._events: list[Event] = []
        self._handed_s = time.monotonic()
        self._ending = False
        self._at_block_since_s: float | None = None  # the sink; None where it is at none
        self._queue: queue.Queue[tuple[Rows, list[Event]] | None] = queue.Queue(self.BACKLOG)
        self._thread = threading.Thread(target=self._write, name="recorder", daemon=True)
        self._thread.start()

    def row(self, row: Row) -> None:
        """Take one row.

        Raises:
            RecordingError: the sink failed or cannot keep up.
        """
        if self._rows.append(row) >= self.BLOCK_ROWS or time.monotonic() - self._handed_s > self.BLOCK_S:
            self._hand_over()

    def event(self, time_s: float, name: str, detail: str) -> None:
        """Take one event; it is handed over with the rows round it."""
        self._events.append((time_s, name, detail))

    def close(self) -> None:
        """Hand over what is left and wait until it is committed.

        Raises:
            RecordingError: the sink failed; what came before the failure is kept.
        """
        try:
            self._hand_over()
        finally:
            self._end()
        self._check()

    def _end(self) -> None:
        self._ending = True
        with suppress(queue.Full):  # then the thread sees `_ending` once it has worked through the backlog
            self._queue.put_nowait(None)
        self._thread.join(self.LAST_PATIENCE_S)
        if self._thread.is_alive():
            raise RecordingError(f"the store has not taken the last rows in {self.LAST_PATIENCE_S:g} s; they are lost")

    def _hand_over(self) -> None:
        self._check()
        self._handed_s = time.monotonic()
        self._check_progress()
        rows = self._rows.rows()
        if len(rows) == 0 and not self._events:
            return
        block = rows, self._events
        try:
            if self._patience_s > 0.0:
                self._queue.put(block, timeout=self._patience_s)
            else:
                self._queue.put_nowait(block)
        except queue.Full:
            raise RecordingError(
                f"the store does not keep up: {self.BACKLOG} blocks are waiting for it; look for a full or failing disk"
            ) from None
        self._rows.clear()
        self._events = []

    def _check(self) -> None:
        if self.error is not None:
            raise RecordingError(f"the store failed: {self.error}") from self.error

    def _check_progress(self) -> None:
        since_s = self._at_block_since_s
        if self._patience_s == 0.0 and since_s is not None and self._handed_s - since_s > self.STALL_S:
            raise RecordingError(
                f"the store does not keep up: it has been at one block for more than {self.STALL_S:g} s; "
                "look for a locked database, or a failing disk"
            )

    def _write(self) -> None:
        while not (self._ending and self._queue.empty()):
            block = self._queue.get()
            if block is None:
                return
            if self.error is not None:
                continue  # drain, so that the loop is never blocked by a sink that is gone
            try:
                self._at_block_since_s = time.monotonic()
                self._sink.append(*block)
            except BaseException as error:  # whatever it is, the loop has to hear of it
                self.error = error
            finally:
                self._at_block_since_s = None
