"""Calls to the bench process whose replies are waited for."""

import threading
from concurrent.futures import Future
from typing import Any

from bench.runs.bench_process.errors import BenchProcessError, NotBegunError
from bench.runs.bench_process.messages import Failure, Reply, error_of


class Calls:
    """Each has a number, and a future for what comes of it. Any thread may use it."""

    def __init__(self) -> None:
        self._open: dict[int, Future[Any]] = {}
        self._accepted: set[int] = set()
        self._number = 0
        self._lock = threading.Lock()

    def open(self) -> tuple[int, Future[Any]]:
        """A new call."""
        with self._lock:
            self._number += 1
            found = self._open[self._number] = Future()
            return self._number, found

    def accept(self, number: int) -> None:
        """One has been begun."""
        with self._lock:
            self._accepted.add(number)

    def close(self, reply: Reply | Failure) -> None:
        """What came of one."""
        found = self._pop(reply.number)
        if found is None:
            return
        if isinstance(reply, Failure):
            found.set_exception(error_of(reply))
        else:
            found.set_result(reply.value)

    def forget(self, number: int) -> None:
        """Nobody waits for it any more."""
        self._pop(number)

    def fail(self, said: BaseException | None, reason: str) -> None:
        """No more replies will come: the process has ended."""
        with self._lock:
            left, accepted = dict(self._open), set(self._accepted)
        for number in left:
            if (found := self._pop(number)) is not None:
                kind = BenchProcessError if number in accepted else NotBegunError
                found.set_exception(said or kind(reason))

    def _pop(self, number: int) -> "Future[Any] | None":
        with self._lock:
            self._accepted.discard(number)
            return self._open.pop(number, None)
