"""Starts Feetech servos behind a pseudo-terminal."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.feetech.packets import InstructionReader
from sim_backend.devices.feetech.servo import StsServo
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.link.line import Line
from sim_backend.devices.link.serial_port import SerialPort
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.servos.bus import ServoBus

_MEASURED = {"encoder": {"counts_per_turn": 4096, "speed_window_s": 0.005}}


@dataclass(frozen=True, kw_only=True)
class FeetechBusSettings:
    """Servos, their joints and their line.

    Attributes:
        ids: of each; two of one id answer at once.
        baud: pace of the line; None is as fast as the machine.
        link: symbolic link to put on the port; None: none.
        preset: of the joint behind each.
        plant: tables that differ from it.
        seed: of the first; the others have the next ones.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    ids: tuple[int, ...] = (1,)
    baud: int | None = None
    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None


def serve_feetech(settings: FeetechBusSettings) -> RunningDevice:
    """Start them. The port stays where it is while the line is not disconnected.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    parameters = behind_a_drive(settings.preset, _MEASURED, settings.plant)
    first = 0 if len(set(settings.ids)) == len(settings.ids) else 500  # bits to be lost where two answer at once
    servos = [
        StsServo(parameters, servo_id, settings.seed + place, first + 1000 * place)
        for place, servo_id in enumerate(settings.ids)
    ]
    device = ServoBus(servos, InstructionReader())
    return RunningDevice(
        device,
        lambda place: SerialPort(device, place.clock, Line(settings.baud, place.faults, settings.seed), settings.link),
        settings.side_port,
        settings.patience_s,
    )
