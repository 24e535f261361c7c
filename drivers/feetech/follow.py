"""A Feetech servo that another program moves."""

from pathlib import Path

from drivers.feetech import memory
from drivers.feetech.frames import SCS
from drivers.feetech.memory import reading_of
from drivers.feetech.settings import FeetechSettings
from drivers.joint import JointScale
from drivers.servos.opening import check_counts
from drivers.servos.relay import ServoFollower, ServoRelay, number_of, unknown_model
from drivers.wraps import Turns


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
    line = settings.port, settings.baud_rate, settings.answer_timeout_s, SCS, settings.servo_id
    number = number_of(*line, memory.MODEL_NUMBER)
    name = memory.MODELS.get(number)
    if name is None:
        raise unknown_model(settings.device, number)
    check_counts(settings.device, name, memory.COUNTS_PER_TURN, joint)
    turns = Turns(memory.COUNTS_PER_TURN)
    relay = ServoRelay(*line, memory.PIECE, link, period_s)
    return ServoFollower(
        relay, f"Feetech {name}", settings.device, lambda data, asked_s: reading_of(data, asked_s, turns), joint
    )
