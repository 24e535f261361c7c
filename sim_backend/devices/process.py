"""A simulated device at work: its ticker, its port, its side channel; started together and ended together."""

from collections.abc import Callable
from dataclasses import dataclass
from threading import Event
from typing import Protocol, Self

from sim_backend.devices.axis import Device
from sim_backend.devices.hand import Hand
from sim_backend.devices.link.faults import LinkFaults
from sim_backend.devices.side_channel import SideChannel
from sim_backend.devices.wall_time import PatientTime, Ticker, WallTime


class Port(Protocol):
    """What carries the protocol, in threads of its own."""

    @property
    def path(self) -> str:
        """What a host opens."""

    @property
    def error(self) -> BaseException | None:
        """What ended a thread before its time."""

    def start(self) -> None:
        """Begin."""

    def close(self) -> None:
        """End."""


@dataclass(frozen=True)
class Workplace:
    """What a port needs beside the device."""

    clock: WallTime
    faults: LinkFaults


class RunningDevice:
    """A device in wall-clock time.

    Args:
        device: not yet advanced.
        make_port: its port; the faults it is given are those of the side channel.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: of `PatientTime` [s]; None: time waits for nobody.
    """

    def __init__(
        self,
        device: Device,
        make_port: Callable[[Workplace], Port],
        side_port: int = 0,
        patience_s: float | None = None,
    ) -> None:
        clock = WallTime() if patience_s is None else PatientTime(device.axis, patience_s)
        workplace = Workplace(clock, LinkFaults())
        self.device = device
        self._ticker = Ticker(device, workplace.clock)
        self._port = make_port(workplace)
        self._side_channel = SideChannel(Hand(device, workplace.clock, workplace.faults), side_port)
        self._ticker.start()
        self._port.start()

    @property
    def path(self) -> str:
        """What a host opens."""
        return self._port.path

    @property
    def side_channel(self) -> str:
        """Where the side channel listens, as host:port."""
        return self._side_channel.address

    def wait(self, stop: Event) -> None:
        """Return when `stop` is set.

        Raises:
            BaseException: whatever has ended the ticker or the port before.
        """
        while not stop.wait(0.1):
            for thread in (self._ticker, self._port):
                if thread.error is not None:
                    raise thread.error

    def close(self) -> None:
        """End every thread and port."""
        self._side_channel.close()
        self._port.close()
        self._ticker.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
