"""The drive contract on one Damiao actuator, and a listener to one that another host drives."""

from math import pi

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.contract import Mode
from drivers.damiao import protocol
from drivers.damiao.actuator import DamiaoActuator
from drivers.damiao.settings import DamiaoSettings
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale
from drivers.mit.actuator import reading_of

_MODES = frozenset({Mode.TORQUE})
_OPENING_QUESTIONS = 16


class DamiaoDrive(ActuatorDrive[DamiaoActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

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
        )


def follow(settings: DamiaoSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveError: its model is left out, or the bus does not open.
    """
    if not settings.model:
        raise DriveConfigurationError(
            settings.device,
            "drive.model is left out. Its ranges are not asked for while another host drives it: set drive.model to "
            f"one of {', '.join(protocol.MODELS)}",
        )
    ranges, counts_rad = protocol.MODELS[settings.model], joint.counts_per_turn / (2.0 * pi)

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        data = heard.data
        is_other = len(data) != 8 or data[0] & 0x0F != settings.motor_id & 0x0F
        if is_other or protocol.is_register(data, settings.motor_id, data[3]):
            return None
        state, moves, temperature_c = protocol.feedback(data, ranges)
        is_on = state == protocol.ENABLED
        return reading_of(heard.at_s, moves, counts_rad, temperature_c, is_on, protocol.error_name(state))

    return BusFollower(settings.bus, settings.feedback_id, (f"Damiao {settings.model}", settings.device), taken, joint)
