"""The drive contract on one Damiao actuator."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.can_bus.port import on_bus
from drivers.contract import Mode
from drivers.damiao.actuator import DamiaoActuator
from drivers.damiao.settings import DamiaoSettings
from drivers.joint import JointScale
from drivers.mit.actuator import exchange_all

_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 16


class DamiaoDrive(ActuatorDrive[DamiaoActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: DamiaoSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "Damiao", _MODES, "communication timeout", settings.watchdog_s, 2 * answer_s,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: DamiaoActuator(port, settings, joint, leave)),
            exchange_all,
        )
