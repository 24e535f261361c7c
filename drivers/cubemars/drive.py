"""The drive contract on one CubeMars actuator."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.can_bus.port import on_bus
from drivers.cubemars.actuator import CubemarsActuator
from drivers.cubemars.settings import CubemarsSettings
from drivers.joint import JointScale
from drivers.mit.actuator import exchange_all

_OPENING_QUESTIONS = 6


class CubemarsDrive(ActuatorDrive[CubemarsActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: CubemarsSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "CubeMars", CubemarsActuator.modes, "", None, 2 * answer_s, _OPENING_QUESTIONS * answer_s
        )
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: CubemarsActuator(port, settings, joint, leave)),
            exchange_all,
        )
