"""The drive contract on one moteus controller."""

from typing import Any

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.contract import Mode
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.moteus.opening import on_line
from drivers.moteus.settings import MoteusSettings

_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 40  # of its console, mostly
_BEGIN_S = 1.0


class MoteusDrive(ActuatorDrive[Any]):  # of MoteusActuator, which is imported with the library
    """One controller with its joint, by torque. It counts turns of its output; `rig.gear` is what is behind that.

    Args:
        settings: how to reach it.
        joint: scales and signs.

    Raises:
        DriveConfigurationError: the library `moteus` is not installed.
    """

    def __init__(self, settings: MoteusSettings, joint: JointScale) -> None:
        try:
            from drivers.moteus.actuator import MoteusActuator, exchange_all
        except ImportError as error:
            raise DriveConfigurationError(
                settings.device, f"mjbots' library is wanted ({error}): pip install 'friction-bench[moteus]'"
            ) from error
        answer_s = 2 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "mjbots", _MODES, "watchdog", settings.watchdog_s, 2 * answer_s + _BEGIN_S,
            _OPENING_QUESTIONS * answer_s,
        )  # fmt: skip
        super().__init__(
            family,
            joint,
            lambda: on_line(settings, lambda line, leave: MoteusActuator(line, settings, joint, leave)),
            exchange_all,
        )
