"""The drive contract on one axis of an ODrive."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.can_bus.port import on_bus
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.odrive.actuator import OdriveActuator, exchange_all
from drivers.odrive.settings import OdriveSettings

_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 8
_STATE_S = 1.0  # longest wait for a change of state, and for the heartbeat that shows it


class OdriveDrive(ActuatorDrive[OdriveActuator]):
    """One axis with its joint, by torque; `rig.motor.torque_constant_n_m_a` makes one of a current.

    Args:
        settings: how to reach it.
        joint: scales and signs.
    """

    def __init__(self, settings: OdriveSettings, joint: JointScale) -> None:
        answer_s = 2 * settings.answer_timeout_s + _STATE_S
        family = Family(
            settings.device, "ODrive", _MODES, "watchdog", settings.watchdog_s, answer_s + _STATE_S,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(family, joint, lambda: _opened(settings, joint), exchange_all)


def _opened(settings: OdriveSettings, joint: JointScale) -> OdriveActuator:
    if not settings.bus.sends_remote_frames:
        raise DriveConfigurationError(
            settings.device,
            f"python-can sends no remote frames over {settings.bus.interface}, and CANSimple asks with them; use "
            "socketcan or slcan",
        )
    return on_bus(settings.bus, lambda port, leave: OdriveActuator(port, settings, joint, leave))
