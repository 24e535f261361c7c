"""Starts a RoboClaw behind a pseudo-terminal."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.link.line import Line
from sim_backend.devices.link.serial_port import SerialPort
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.roboclaw.device import MEASURED, RoboClaw


@dataclass(frozen=True, kw_only=True)
class RoboClawSettings:
    """A RoboClaw, its joint and its line.

    Attributes:
        address: 0x80 .. 0x87.
        usb: over USB every address is its own.
        baud: pace of the line; None is as fast as the machine.
        link: symbolic link to put on the port; None: none.
        preset, plant, seed: the joint.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    address: int = 0x80
    usb: bool = False
    baud: int | None = None
    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None


def serve_roboclaw(settings: RoboClawSettings) -> RunningDevice:
    """Start one. Its port stays where it is while the line is not disconnected.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    parameters = behind_a_drive(settings.preset, MEASURED, settings.plant)
    device = RoboClaw(parameters, settings.address, settings.usb, settings.seed)
    return RunningDevice(
        device,
        lambda place: SerialPort(device, place.clock, Line(settings.baud, place.faults, settings.seed), settings.link),
        settings.side_port,
        settings.patience_s,
    )
