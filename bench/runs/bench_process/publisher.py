"""Tells the service what the bench does, many times a second while it does something."""

import threading
from dataclasses import replace
from multiprocessing.connection import Connection

from bench.runs.bench_process.messages import Accepted, Seen
from bench.runs.runner import Runner

PERIOD_S = 0.02  # shorter than a block of the recorder: each is told by itself
MOST_ROWS = 20_000
GONE = (OSError, ValueError)  # the service has closed its end; ValueError: this end is closed


class Publisher:
    """All that is sent to the service: messages go out whole, and what was seen later goes out later.

    Where the service does not read, this waits, and nothing else does.
    """

    def __init__(self, runner: Runner, connection: "Connection") -> None:
        self._runner = runner
        self._connection = connection
        self._sending = threading.Lock()
        self._woken = threading.Event()
        self._calls = 0  # under way
        self._last_row = -1
        self._told: object = None
        threading.Thread(target=self._run, name="publisher", daemon=True).start()

    def begin_call(self, number: int) -> None:
        """Say that a call has come: something is about to change."""
        self.tell(Accepted(number))
        self._calls += 1
        self._woken.set()

    def end_call(self, reply: object) -> None:
        """Send what has changed, then what came of the call."""
        self.tell(reply)
        self._calls -= 1
        self._woken.set()

    def tell(self, message: object = None) -> None:
        """Send what has happened since the last time, then a message."""
        with self._sending:
            try:
                self._tell_news()
                if message is not None:
                    self._connection.send(message)
            except GONE:
                pass  # whoever receives hears of it, too

    def _run(self) -> None:
        while True:
            if self._runner.wait(PERIOD_S):  # returns as soon as nothing runs
                self.tell()
                self._woken.wait(PERIOD_S if self._calls else None)
                self._woken.clear()
            self.tell()

    def _tell_news(self) -> None:
        status, busy = self._runner.status(), not self._runner.wait(0.0)
        rows = self._runner.live(self._last_row, MOST_ROWS)
        # a new reading alone is no news: it comes with its row
        news = (replace(status, reading=None, progress=0.0), busy, rows.last_row)
        if news == self._told:
            return
        self._connection.send(Seen(status, busy, rows))
        self._told, self._last_row = news, rows.last_row
