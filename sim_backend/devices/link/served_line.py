"""A simulated device on a serial line."""

from dataclasses import dataclass

from sim_backend.devices.link.line import Line
from sim_backend.devices.link.serial_port import ByteDevice, SerialPort
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.served import Served


@dataclass(frozen=True, kw_only=True)
class ServedOnLine(Served):
    """Its joint and its line.

    Attributes:
        baud: pace of the line; None is as fast as the machine.
    """

    baud: int | None = None

    def on_pseudo_terminal(self, device: ByteDevice) -> RunningDevice:
        """Return the device at work. Its port stays where it is while the line is not disconnected.

        Raises:
            OSError: the link or the side channel's port is taken.
        """
        return self.running(
            device, lambda place: SerialPort(device, place.clock, Line(self.baud, place.faults, self.seed), self.link)
        )
