"""The drive contract on one Feetech servo."""

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.contract import Mode
from drivers.feetech.actuator import FeetechActuator
from drivers.feetech.frames import SCS
from drivers.feetech.settings import FeetechSettings
from drivers.joint import JointScale
from drivers.servos.actuator import exchange_all
from drivers.servos.bus import ServoBus
from drivers.servos.opening import on_line

_MODES = frozenset({Mode.DUTY, Mode.POSITION})
_OPENING_QUESTIONS = 10


class FeetechDrive(ActuatorDrive[FeetechActuator]):
    """One servo with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: FeetechSettings, joint: JointScale) -> None:
        answer_s = ServoBus.longest_call_s(settings.answer_timeout_s)
        family = Family(settings.device, "Feetech", _MODES, "", None, answer_s, _OPENING_QUESTIONS * answer_s)
        super().__init__(family, joint, lambda: _opened(settings, joint), exchange_all)


def _opened(settings: FeetechSettings, joint: JointScale) -> FeetechActuator:
    return on_line(
        settings.port,
        settings.baud_rate,
        settings.answer_timeout_s,
        SCS,
        lambda bus, leave: FeetechActuator(bus, settings, joint, leave),
    )
