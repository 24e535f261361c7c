"""Starts Dynamixel servos behind a pseudo-terminal."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sim_backend.devices.dynamixel.memory import KINDS
from sim_backend.devices.dynamixel.packets import InstructionReader
from sim_backend.devices.dynamixel.servo import SIMULATED_FIRMWARE, XServo
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.link.line import Line
from sim_backend.devices.link.serial_port import SerialPort
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.servos.bus import ServoBus
from sim_backend.errors import ParameterError

_MEASURED = {"encoder": {"counts_per_turn": 4096, "speed_window_s": 0.005}}


@dataclass(frozen=True, kw_only=True)
class DynamixelBusSettings:
    """Servos, their joints and their line.

    Attributes:
        model: of all of them.
        ids: of each; two of one id answer at once.
        firmware: of all of them; 255 says that they are simulated.
        baud: pace of the line; None is as fast as the machine.
        link: symbolic link to put on the port; None: none.
        preset: of the joint behind each.
        plant: tables that differ from it.
        seed: of the first; the others have the next ones.
        side_port: TCP port of the side channel; 0 is any free one.
        patience_s: how far time goes without a word of the host while the joint is at work [s]; None: for ever.
    """

    model: str = "XM430-W350"
    ids: tuple[int, ...] = (1,)
    firmware: int = SIMULATED_FIRMWARE
    baud: int | None = None
    link: Path | None = None
    preset: str = "paper"
    plant: Mapping[str, Any] | None = None
    seed: int = 1
    side_port: int = 0
    patience_s: float | None = None


def serve_dynamixel(settings: DynamixelBusSettings) -> RunningDevice:
    """Start them. The port stays where it is while the line is not disconnected.

    Raises:
        ParameterError: the joint cannot be, or the model is not known.
        OSError: the link or the side channel's port is taken.
    """
    if settings.model not in KINDS:
        raise ParameterError(f"model '{settings.model}' is unknown; known are {', '.join(KINDS)}")
    parameters = behind_a_drive(settings.preset, _MEASURED, settings.plant)
    kind = KINDS[settings.model]
    servos = [
        XServo(parameters, kind, servo_id, settings.firmware, settings.seed + place)
        for place, servo_id in enumerate(settings.ids)
    ]
    for place, servo in enumerate(servos):
        servo.memory.put(20, "i", 1000 * place)  # Homing Offset: no two stand alike
    device = ServoBus(servos, InstructionReader())
    return RunningDevice(
        device,
        lambda place: SerialPort(device, place.clock, Line(settings.baud, place.faults, settings.seed), settings.link),
        settings.side_port,
        settings.patience_s,
    )
