"""The drive contract on one RobStride actuator."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.can_bus.port import on_bus
from drivers.joint import JointScale
from drivers.mit.actuator import exchange_all
from drivers.robstride.actuator import RobstrideActuator
from drivers.robstride.settings import RobstrideSettings

_OPENING_QUESTIONS = 16


class RobstrideDrive(ActuatorDrive[RobstrideActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: RobstrideSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "RobStride", RobstrideActuator.modes, "CAN time-out", settings.watchdog_s, 2 * answer_s,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: RobstrideActuator(port, settings, joint, leave)),
            exchange_all,
        )
