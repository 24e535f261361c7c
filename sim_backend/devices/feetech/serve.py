"""Starts Feetech servos behind a pseudo-terminal."""

from dataclasses import dataclass

from sim_backend.devices.feetech.packets import InstructionReader
from sim_backend.devices.feetech.servo import StsServo
from sim_backend.devices.link.serial_port import ServedOnLine
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.servos.bus import ServoBus

_MEASURED = {"encoder": {"counts_per_turn": 4096, "speed_window_s": 0.005}}


@dataclass(frozen=True, kw_only=True)
class FeetechBusSettings(ServedOnLine):
    """Servos, their joints and their line.

    Attributes:
        ids: of each; two of one id answer at once.
    """

    ids: tuple[int, ...] = (1,)


def serve_feetech(settings: FeetechBusSettings) -> RunningDevice:
    """Start them.

    Raises:
        ParameterError: the joint cannot be.
        OSError: the link or the side channel's port is taken.
    """
    parameters = settings.joint(_MEASURED)
    first = 0 if len(set(settings.ids)) == len(settings.ids) else 500  # bits to be lost where two answer at once
    servos = [
        StsServo(parameters, servo_id, settings.seed + place, first + 1000 * place)
        for place, servo_id in enumerate(settings.ids)
    ]
    return settings.on_pseudo_terminal(ServoBus(servos, InstructionReader()))
