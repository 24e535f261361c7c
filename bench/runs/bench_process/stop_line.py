"""STOP, from the service to the control loop: a few bytes of memory that both processes have.

The control loop looks at them in every cycle. There is no queue, lock or thread between, which could delay STOP, and no
socket, whose buffer could be full.
"""

import mmap
import os
import tempfile
import threading
from pathlib import Path
from typing import Self

from bench.control.ending import StopRequest

_COUNT_BYTES = 8
_SLOTS = 16  # reasons kept; the oldest go
_SLOT_BYTES = 1024
_SIZE = _COUNT_BYTES + _SLOTS * _SLOT_BYTES


class StopLine:
    """How often STOP was asked for, and why.

    One process asks; any number look.

    Args:
        file: descriptor of the memory; stays the caller's.
    """

    def __init__(self, file: int) -> None:
        self._memory = mmap.mmap(file, _SIZE)
        self._counts = memoryview(self._memory)[:_COUNT_BYTES].cast("q")  # one store of a word: never half written
        self._asking = threading.Lock()

    @classmethod
    def make(cls) -> tuple[Self, int]:
        """A new line, and the descriptor that the other process needs."""
        file = _anonymous_file()
        os.ftruncate(file, _SIZE)
        return cls(file), file

    @classmethod
    def make_at(cls, path: Path) -> Self:
        """A new line that another process finds by its path. This user alone may open it.

        Raises:
            OSError: it cannot be made.
        """
        file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
        try:
            os.posix_fallocate(file, 0, _SIZE)  # a full disk is met here, and not when somebody asks for STOP
            return cls(file)
        finally:
            os.close(file)

    @classmethod
    def at(cls, path: Path) -> Self:
        """The line at a path.

        Raises:
            OSError: there is none.
        """
        file = os.open(path, os.O_RDWR | os.O_NOFOLLOW)
        try:
            return cls(file)
        finally:
            os.close(file)

    def asked(self) -> int:
        """How often STOP has been asked for."""
        return self._counts[0]

    def settled(self) -> int:
        """The same, after whoever is about to ask has done so. Not for signal handlers."""
        with self._asking:
            return self._counts[0]

    def ask(self, reason: str = "") -> None:
        """Ask for STOP. Waits for nothing: safe in a signal handler."""
        if not self._asking.acquire(blocking=False):
            return  # somebody else asks at this moment, or was interrupted by this signal while doing so: that counts
        try:
            number = self._counts[0] + 1
            text = reason.encode(errors="replace")[: _SLOT_BYTES - 2]
            begin = _slot(number)
            self._memory[begin : begin + 2 + len(text)] = len(text).to_bytes(2, "big") + text
            self._counts[0] = number  # last: who sees it sees the reason, too
        finally:
            self._asking.release()

    def reason(self, number: int) -> str:
        """Why STOP was asked for, the time of a number, from 1; "" where nobody said."""
        begin = _slot(number)
        length = min(int.from_bytes(self._memory[begin : begin + 2], "big"), _SLOT_BYTES - 2)
        return self._memory[begin + 2 : begin + 2 + length].decode(errors="ignore")


class LineStop(StopRequest):
    """The wish of an experiment to end, which the stop line can have, too.

    Args:
        line: looked at each time that somebody wants to know.
        before: how often STOP had been asked for before the experiment: that does not count.
    """

    def __init__(self, line: StopLine, before: int) -> None:
        super().__init__()
        self._line = line
        self._before = before

    def is_set(self) -> bool:
        """Whether the end is wished for."""
        if super().is_set():
            return True
        if self._line.asked() == self._before:
            return False
        self.reason = self._line.reason(self._before + 1) or self.reason
        self.set()
        return True


def _slot(number: int) -> int:
    return _COUNT_BYTES + number % _SLOTS * _SLOT_BYTES


def _anonymous_file() -> int:
    """A file without a name: nothing is left of it when both processes are gone, however they went."""
    if hasattr(os, "memfd_create"):
        return os.memfd_create("friction-bench stop")
    with tempfile.TemporaryFile() as file:
        return os.dup(file.fileno())
