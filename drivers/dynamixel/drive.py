"""The drive contract on one Dynamixel."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.open_buses import OpenBuses
from drivers.contract import Mode
from drivers.dynamixel.actuator import DynamixelActuator, exchange_all
from drivers.dynamixel.bus import Bus
from drivers.dynamixel.control_table import GATHERED
from drivers.dynamixel.settings import DynamixelSettings
from drivers.joint import JointScale

_MODES = frozenset({Mode.DUTY, Mode.CURRENT, Mode.POSITION})  # at most: a model without a sensor has no CURRENT
_OPENING_QUESTIONS = 2 * len(GATHERED) + 12
_BUSES: OpenBuses[Bus] = OpenBuses()  # servos of one line share its port
_REBOOT_S = 4.0  # of `clear_fault`


class DynamixelDrive(ActuatorDrive[DynamixelActuator]):
    """One servo with its joint. The servo counts as the motor, its own gear included; `rig.gear` is what is behind it.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: DynamixelSettings, joint: JointScale) -> None:
        answer_s = Bus.longest_call_s(settings.answer_timeout_s)
        family = Family(
            settings.device, "ROBOTIS", _MODES, "bus watchdog", settings.set_watchdog_s,
            answer_s + _REBOOT_S, _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(family, joint, lambda: _connect(settings, joint), exchange_all)


def _connect(settings: DynamixelSettings, joint: JointScale) -> DynamixelActuator:
    key = settings.port, settings.baud_rate

    def connect() -> Bus:
        return Bus(settings.port, settings.baud_rate, settings.answer_timeout_s)

    bus = _BUSES.enter(key, connect)
    try:
        return DynamixelActuator(bus, settings, joint, lambda: _BUSES.leave(key))
    except BaseException:
        _BUSES.leave(key)
        raise
