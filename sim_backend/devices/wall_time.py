"""A device in wall-clock time."""

import threading
import time

from sim_backend.devices.axis import TICK_S
from sim_backend.devices.device import Device


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
