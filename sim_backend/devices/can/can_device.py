"""What a transport asks of a device on a CAN bus."""

from typing import Protocol

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.canopen.node import Node
from sim_backend.devices.device import Device


class CanDevice(Device, Protocol):
    """A device with a node."""

    node: Node

    def receive(self, frame: Frame, time_s: float) -> None:
        """Take a frame at a time [s]; answers go out through `node.send`."""
