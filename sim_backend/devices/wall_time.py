"""A device in wall-clock time."""

import threading
import time

from sim_backend.devices.axis import TICK_S, Axis, Device

# silence of a host that is gone, not late: time goes on, and a watchdog of 1 s trips in the 1.6 s that it is tried for
HOST_IS_GONE_S = 0.45
HOST_LISTENS_S = 0.3  # the same without power: a host that waits for a heartbeat is silent, too


class WallTime:
    """The axis' time by the wall clock: 0 when made.

    Attributes:
        origin_s: `time.monotonic()` at 0. Processes of one machine share that clock.
    """

    def __init__(self) -> None:
        self.origin_s = time.monotonic()

    def now_s(self) -> float:
        """Return the time [s]."""
        return time.monotonic() - self.origin_s

    def hear(self) -> None:
        """The host has sent something."""


class PatientTime(WallTime):
    """Time that waits for a late host: while motor or joint is at work, it goes only so far without a word of it.

    For trials on a machine that is busy with other work. A drive's own processor goes on with the last command while a
    host waits for its turn; so does this one, but no longer than a host on a machine of its own would be late.

    Attributes:
        origin_s: as of `WallTime`, put off by what was waited.

    Args:
        axis: whose motor is powered, whose joint moves, or neither.
        patience_s: how far time goes without a word of the host [s].
    """

    def __init__(self, axis: Axis, patience_s: float) -> None:
        super().__init__()
        self._axis = axis
        self._patience_s = patience_s
        self._lock = threading.Lock()
        self._now_s = 0.0
        self._looked_s = self._heard_s = self.origin_s  # of `time.monotonic()`
        self._heard_at_s = 0.0  # of the axis

    def now_s(self) -> float:
        """Return the time [s]."""
        with self._lock:
            return self._advance()

    def hear(self) -> None:
        """The host has sent something."""
        with self._lock:
            self._heard_at_s = self._advance()
            self._heard_s = self._looked_s

    def _advance(self) -> float:
        looked_s = time.monotonic()
        step_s, self._looked_s = looked_s - self._looked_s, looked_s
        longest_s = self._longest_wait_s()
        if longest_s:
            silent_s = max(looked_s - self._heard_s - longest_s, 0.0)  # beyond what a late host may take
            step_s = min(step_s, max(self._heard_at_s + self._patience_s + silent_s - self._now_s, 0.0))
        self._now_s += step_s
        self.origin_s = looked_s - self._now_s
        return self._now_s

    def _longest_wait_s(self) -> float:
        if self._axis.power.on:
            return HOST_IS_GONE_S
        return HOST_LISTENS_S if self._axis.seen.velocity_rad_s != 0.0 else 0.0


class Ticker(threading.Thread):
    """Advances a device to the present, a thousand times a second.

    What it is late it makes up: the device's time is the clock's, not a sum of naps.
    """

    def __init__(self, device: Device, clock: WallTime) -> None:
        super().__init__(name="device ticker", daemon=True)
        self._device = device
        self._clock = clock
        self._closing = threading.Event()
        self.error: BaseException | None = None

    def run(self) -> None:
        """Tick until `close`."""
        next_s = self._clock.now_s()
        try:
            while not self._closing.wait(max(next_s - self._clock.now_s(), 0.0)):
                now_s = self._clock.now_s()
                next_s = max(next_s + TICK_S, now_s)
                with self._device.lock:
                    self._device.advance_to(now_s)
        except BaseException as error:
            self.error = error
            raise

    def close(self) -> None:
        """End the thread."""
        self._closing.set()
        self.join()
