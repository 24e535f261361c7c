"""Calls to the bench process whose replies are waited for."""

import threading
from concurrent.futures import Future, InvalidStateError
from contextlib import suppress
from typing import Any

from bench.bench_process.failures import error_of
from bench.bench_process.messages import Failure, Reply


class Calls:
    """Each has a number, and a future for what comes of it. Any thread may use it."""

    def __init__(self) -> None:
        self._open: dict[int, Future[Any]] = {}
        self._number = 0
        self._lock = threading.Lock()

    def open(self) -> tuple[int, Future[Any]]:
        """A new call."""
        with self._lock:
            self._number += 1
            found = self._open[self._number] = Future()
            return self._number, found

    def close(self, reply: Reply | Failure) -> None:
        """What came of one."""
        with self._lock:
            found = self._open.pop(reply.number, None)
        if found is None:
            return
        if isinstance(reply, Failure):
            found.set_exception(error_of(reply))
        else:
            found.set_result(reply.value)

    def forget(self, number: int) -> None:
        """Nobody waits for it any more."""
        with self._lock:
            self._open.pop(number, None)

    def fail(self, error: BaseException) -> None:
        """No more replies will come."""
        with self._lock:
            left = list(self._open.values())
            self._open.clear()
        for one in left:
            with suppress(InvalidStateError):
                one.set_exception(error)
