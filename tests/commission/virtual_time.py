"""Virtual time for a host and a simulated device in one process: as fast as the machine, and in order.

Importing this module replaces the clocks of `time` for good, so that drivers imported afterwards read the virtual one.
It belongs into a process of its own (`python -m tests.commission.draws`), never into that of other tests.
"""

import threading
import time

_REAL_SLEEP = time.sleep
_LOOK_S = 2e-6  # that one look at the clock takes: whoever waits by looking gets on


class VirtualTime:
    """A clock that goes on with what is waited for, and with what goes over a line."""

    def __init__(self) -> None:
        self._now_s = 1000.0
        self._lock = threading.Lock()

    def now(self) -> float:
        """The time [s]; a look takes a little of it."""
        return self.advance(_LOOK_S)

    def advance(self, duration_s: float) -> float:
        """Let time pass [s]; the time afterwards."""
        with self._lock:
            self._now_s += max(duration_s, 0.0)
            return self._now_s

    def sleep(self, duration_s: float) -> None:
        """Let it pass for whoever drives the joint; other threads, such as that of the store, really wait."""
        name = threading.current_thread().name
        if name == "MainThread" or name.startswith("experiment"):
            self.advance(duration_s)
        else:
            _REAL_SLEEP(duration_s)


TIME = VirtualTime()
time.perf_counter = time.monotonic = TIME.now  # type: ignore[assignment]
time.sleep = TIME.sleep  # type: ignore[assignment]
