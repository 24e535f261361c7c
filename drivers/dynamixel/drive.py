"""The drive contract on one Dynamixel."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.contract import Mode
from drivers.dynamixel.actuator import DynamixelActuator
from drivers.dynamixel.control_table import GATHERED
from drivers.dynamixel.frames import PROTOCOL_2
from drivers.dynamixel.settings import DynamixelSettings
from drivers.joint import JointScale
from drivers.servos.actuator import exchange_all
from drivers.servos.bus import ServoBus
from drivers.servos.opening import on_line

_MODES = frozenset({Mode.DUTY, Mode.CURRENT, Mode.POSITION})  # at most: a model without a sensor has no CURRENT
_OPENING_QUESTIONS = 2 * len(GATHERED) + 12
_REBOOT_S = 4.0  # of `clear_fault`


class DynamixelDrive(ActuatorDrive[DynamixelActuator]):
    """One servo with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: DynamixelSettings, joint: JointScale) -> None:
        answer_s = ServoBus.longest_call_s(settings.answer_timeout_s)
        family = Family(
            settings.device, "ROBOTIS", _MODES, "bus watchdog", settings.set_watchdog_s,
            answer_s + _REBOOT_S, _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(family, joint, lambda: _opened(settings, joint), exchange_all)


def _opened(settings: DynamixelSettings, joint: JointScale) -> DynamixelActuator:
    return on_line(
        settings.port,
        settings.baud_rate,
        settings.answer_timeout_s,
        PROTOCOL_2,
        lambda bus, leave: DynamixelActuator(bus, settings, joint, leave),
    )
