"""Starts Dynamixel servos behind a pseudo-terminal."""

from dataclasses import dataclass

from sim_backend.devices.dynamixel.memory import KINDS
from sim_backend.devices.dynamixel.packets import InstructionReader
from sim_backend.devices.dynamixel.servo import SIMULATED_FIRMWARE, XServo
from sim_backend.devices.link.serial_port import ServedOnLine
from sim_backend.devices.process import RunningDevice
from sim_backend.devices.servos.bus import ServoBus
from sim_backend.errors import ParameterError

_MEASURED = {"encoder": {"counts_per_turn": 4096, "speed_window_s": 0.005}}


@dataclass(frozen=True, kw_only=True)
class DynamixelBusSettings(ServedOnLine):
    """Servos, their joints and their line.

    Attributes:
        model: of all of them.
        ids: of each; two of one id answer at once.
        firmware: of all of them; 255 says that they are simulated.
    """

    model: str = "XM430-W350"
    ids: tuple[int, ...] = (1,)
    firmware: int = SIMULATED_FIRMWARE


def serve_dynamixel(settings: DynamixelBusSettings) -> RunningDevice:
    """Start them.

    Raises:
        ParameterError: the joint cannot be, or the model is not known.
        OSError: the link or the side channel's port is taken.
    """
    if settings.model not in KINDS:
        raise ParameterError(f"model '{settings.model}' is unknown; known are {', '.join(KINDS)}")
    parameters = settings.joint(_MEASURED)
    kind = KINDS[settings.model]
    servos = [
        XServo(parameters, kind, servo_id, settings.firmware, settings.seed + place)
        for place, servo_id in enumerate(settings.ids)
    ]
    for place, servo in enumerate(servos):
        servo.memory.put(20, "i", 1000 * place)  # Homing Offset: no two stand alike
    return settings.on_pseudo_terminal(ServoBus(servos, InstructionReader()))
