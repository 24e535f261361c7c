"""What a transport asks of a device on a CAN bus."""

from collections.abc import Callable
from typing import Protocol

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.device import Device


class CanNode(Protocol):
    """The device's place on the bus.

    Attributes:
        send: takes the frames that go out; set by whoever has the bus.
    """

    send: Callable[[Frame], None]

    def boot(self) -> None:
        """The bus is there: say what is to be said at power-up."""


class CanDevice(Device, Protocol):
    """A device with a node."""

    @property
    def node(self) -> CanNode:
        """Its place on the bus."""

    def receive(self, frame: Frame, time_s: float) -> None:
        """Take a frame at a time [s]; answers go out through `node.send`."""
