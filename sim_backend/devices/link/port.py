"""The thread that a device's port is, and that takes the port away while the line is disconnected."""

import threading
from abc import ABC, abstractmethod

from sim_backend.devices.link.faults import LinkFaultKind
from sim_backend.devices.link.line import Line
from sim_backend.devices.wall_time import WallTime

LOOK_UP_S = 0.02  # how soon a port notices that it shall close or disconnect


class PortThread(threading.Thread, ABC):
    """Serves until `close`."""

    def __init__(self, line: Line, clock: WallTime, name: str) -> None:
        super().__init__(name=name, daemon=True)
        self.error: BaseException | None = None
        self._line = line
        self._clock = clock
        self._closing = threading.Event()

    def run(self) -> None:
        """Serve, or be unplugged."""
        try:
            self._begin()
            while not self._closing.is_set():
                if self._line.faults.holds(LinkFaultKind.DISCONNECT, self._clock.now_s()):
                    self._unplug()
                    self._pass_time()
                else:
                    self._serve()
        except BaseException as error:
            self.error = error
            raise
        finally:
            self._unplug()

    def close(self) -> None:
        """End the thread and the port."""
        self._closing.set()
        if self.is_alive():
            self.join()
        self._unplug()

    def _begin(self) -> None:
        """Do what comes before everything else."""

    def _pass_time(self) -> None:
        """Wait a little while nothing is plugged in."""
        self._closing.wait(LOOK_UP_S)

    @abstractmethod
    def _serve(self) -> None:
        """Plug in where that is to be done, and serve for `LOOK_UP_S` at most."""

    @abstractmethod
    def _unplug(self) -> None:
        """Take the port away. Safe to call twice."""
