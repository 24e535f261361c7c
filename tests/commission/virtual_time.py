"""Virtual time for a host and a simulated device in one process: as fast as the machine, and in order.

Importing this module replaces the clocks of `time` for good, so that drivers imported afterwards read the virtual one.
It belongs into a process of its own (`python -m tests.commission.draws`, `make test-virtual`), never into that of
other tests.
"""

import heapq
import itertools
import threading
import time

_REAL_SLEEP = time.sleep
_LOOK_S = 1e-5  # that one look at the clock takes: whoever waits by looking gets on


class VirtualTime:
    """A clock that goes on with what is waited for, and with what goes over a line."""

    def __init__(self) -> None:
        self._now_s = 1000.0
        self._lock = threading.Lock()
        self._order = itertools.count()
        self._together: set[threading.Thread] = set()
        self._asleep: list[tuple[float, int, threading.Event]] = []

    def now(self) -> float:
        """The time [s]; a look takes a little of it."""
        with self._lock:  # as `advance`, which is too far for what is asked most
            self._now_s += _LOOK_S
            return self._now_s

    def advance(self, duration_s: float) -> float:
        """Let time pass [s]; the time afterwards."""
        with self._lock:
            self._now_s += max(duration_s, 0.0)
            return self._now_s

    def sleep(self, duration_s: float) -> None:
        """Let it pass for whoever drives the joint; other threads, such as that of the store, really wait."""
        thread = threading.current_thread()
        if thread in self._together:
            self._take_turns(duration_s)
        elif thread.name == "MainThread" or thread.name.startswith("experiment"):
            self.advance(duration_s)
        else:
            _REAL_SLEEP(duration_s)

    def join_in(self, thread: threading.Thread) -> threading.Event:
        """Let a thread share the time with the one that calls: one of them runs at a time, in the order of their waits.

        Returns:
            What is set when it is its turn for the first time.
        """
        self._together |= {threading.current_thread(), thread}
        with self._lock:
            return self._put_to_sleep(self._now_s)

    def leave(self, thread: threading.Thread) -> None:
        """It shares the time no more: the next one goes on."""
        with self._lock:
            self._together.discard(thread)
            self._wake_next()

    def _take_turns(self, duration_s: float) -> None:
        with self._lock:
            wake_s = self._now_s + max(duration_s, 0.0)
            if not self._asleep or self._asleep[0][0] > wake_s:
                self._now_s = wake_s
                return
            turn = self._put_to_sleep(wake_s)
            self._wake_next()
        turn.wait()

    def _put_to_sleep(self, wake_s: float) -> threading.Event:
        turn = threading.Event()
        heapq.heappush(self._asleep, (wake_s, next(self._order), turn))
        return turn

    def _wake_next(self) -> None:
        if self._asleep:
            wake_s, _, turn = heapq.heappop(self._asleep)
            self._now_s = max(self._now_s, wake_s)
            turn.set()


TIME = VirtualTime()
time.perf_counter = time.monotonic = TIME.now
time.sleep = TIME.sleep  # type: ignore[assignment]


class VirtualThread(threading.Thread):
    """A thread that shares virtual time with the one that starts it."""

    _turn = threading.Event()
    _is_over = False

    def start(self) -> None:
        """It runs when the one that starts it waits."""
        self._turn = TIME.join_in(self)
        super().start()

    def run(self) -> None:
        """Run, and let the other one go on."""
        self._turn.wait()
        try:
            super().run()
        finally:
            self._is_over = True
            TIME.leave(self)

    def join(self, timeout: float | None = None) -> None:
        """Wait for it, in virtual time."""
        end_s = TIME.now() + (1e9 if timeout is None else timeout)
        while not self._is_over and TIME.now() < end_s:
            TIME.sleep(1e-3)

    def is_alive(self) -> bool:
        """Whether it has something to do yet."""
        return not self._is_over and super().is_alive()
