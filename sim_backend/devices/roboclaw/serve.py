"""Starts a RoboClaw behind a pseudo-terminal."""

from dataclasses import dataclass

from sim_backend.devices.link.serial_port import ServedOnLine
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.roboclaw.device import MEASURED, RoboClaw


@dataclass(frozen=True, kw_only=True)
class RoboClawSettings(ServedOnLine):
    """A RoboClaw, its joint and its line.

    Attributes:
        address: 0x80 .. 0x87.
        usb: over USB every address is its own.
    """

    address: int = 0x80
    usb: bool = False


def serve_roboclaw(settings: RoboClawSettings) -> RunningDevice:
    """Start one.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    device = RoboClaw(settings.joint(MEASURED), settings.address, settings.usb, settings.seed)
    return settings.on_pseudo_terminal(device)
