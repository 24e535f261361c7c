"""The drive contract on one Feetech servo, and on one that another program moves."""

from pathlib import Path

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.contract import Mode
from drivers.feetech import memory
from drivers.feetech.actuator import FeetechActuator
from drivers.feetech.frames import SCS
from drivers.feetech.memory import reading_of
from drivers.feetech.settings import FeetechSettings
from drivers.joint import JointScale
from drivers.servos.bus import ServoBus
from drivers.servos.opening import check_counts, on_line
from drivers.servos.relay import ServoFollower, asked_model
from drivers.wraps import Turns

_MODES = frozenset({Mode.DUTY, Mode.POSITION})
_OPENING_QUESTIONS = 10


class FeetechDrive(ActuatorDrive[FeetechActuator]):
    """One servo with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: FeetechSettings, joint: JointScale) -> None:
        answer_s = ServoBus.longest_call_s(settings.answer_timeout_s)
        family = Family(settings.device, "Feetech", _MODES, "", None, answer_s, _OPENING_QUESTIONS * answer_s)
        super().__init__(
            family,
            joint,
            lambda: on_line(settings, SCS, lambda bus, leave: FeetechActuator(bus, settings, joint, leave)),
        )


def follow(settings: FeetechSettings, joint: JointScale, link: Path, period_s: float) -> ServoFollower:
    """Stand between another program and the servo.

    Args:
        settings: which servo.
        joint: scales and signs.
        link: name of the port that the other program opens.
        period_s: from one look to the next, at least [s].

    Raises:
        DriveError: the port is not there or in use, nobody answers, or it is another servo than the rig's.
    """
    name = asked_model(settings, SCS, memory.MODEL_NUMBER, memory.MODELS)
    check_counts(settings.device, name, memory.COUNTS_PER_TURN, joint)
    turns = Turns(memory.COUNTS_PER_TURN)
    return ServoFollower(
        settings, SCS, memory.PIECE, link, period_s, f"Feetech {name}",
        lambda data, asked_s: reading_of(data, asked_s, turns), joint,
    )  # fmt: skip
