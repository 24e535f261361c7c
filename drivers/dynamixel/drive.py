"""The drive contract on one Dynamixel, and on one that another program moves."""

from math import nan
from pathlib import Path
from struct import Struct

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.contract import Mode
from drivers.dynamixel import control_table as table
from drivers.dynamixel.actuator import DynamixelActuator
from drivers.dynamixel.frames import PROTOCOL_2
from drivers.dynamixel.models import MODELS, Model
from drivers.dynamixel.settings import DynamixelSettings
from drivers.joint import JointScale
from drivers.servos.bus import ServoBus
from drivers.servos.frames import Item
from drivers.servos.opening import check_counts, on_line
from drivers.servos.relay import ServoFollower, asked_model

_MODES = frozenset({Mode.DUTY, Mode.CURRENT, Mode.POSITION})  # at most: a model without a sensor has no CURRENT
_OPENING_QUESTIONS = 2 * len(table.GATHERED) + 12
_REBOOT_S = 4.0  # of `clear_fault`

# read where the maker has put it, as nothing is written to a servo that another program moves: Present PWM, Current,
# Velocity, Position; two trajectories; Input Voltage, Temperature
_PIECE = Item(124, 23, "what it measures")
_LAYOUT = Struct("<hhii8xHB")


class DynamixelDrive(ActuatorDrive[DynamixelActuator]):
    """One servo with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: DynamixelSettings, joint: JointScale) -> None:
        answer_s = ServoBus.longest_call_s(settings.answer_timeout_s)
        family = Family(
            settings.device, "ROBOTIS", _MODES, "bus watchdog", settings.set_watchdog_s,
            answer_s + _REBOOT_S, _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_line(settings, PROTOCOL_2, lambda bus, leave: DynamixelActuator(bus, settings, joint, leave)),
        )


def follow(settings: DynamixelSettings, joint: JointScale, link: Path, period_s: float) -> ServoFollower:
    """Stand between another program and the servo.

    Args:
        settings: which servo.
        joint: scales and signs.
        link: name of the port that the other program opens.
        period_s: from one look to the next, at least [s].

    Raises:
        DriveError: the port is not there or in use, nobody answers, or it is another servo than the rig's.
    """
    model = asked_model(settings, PROTOCOL_2, table.MODEL_NUMBER, MODELS)
    check_counts(settings.device, model.name, table.COUNTS_PER_TURN, joint)
    return ServoFollower(
        settings, PROTOCOL_2, _PIECE, link, period_s, f"ROBOTIS {model.name}",
        lambda data, asked_s: _reading(data, asked_s, model), joint,
    )  # fmt: skip


def _reading(data: bytes, asked_s: float, model: Model) -> Reading:
    """The piece in SI. Whether it is powered is not in it: who moves is."""
    pwm, current, velocity, position, supply, temperature = _LAYOUT.unpack(data)
    return Reading(
        asked_s, position, velocity * table.COUNTS_S, pwm / table.DUTY_FULL,
        nan if model.current_a is None else current * model.current_a, nan,
        supply * table.SUPPLY_V, temperature, True,
    )  # fmt: skip
