"""The drive contract on one CubeMars actuator, and a listener to one that another host drives."""

from math import pi

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.cubemars import protocol
from drivers.cubemars.actuator import CubemarsActuator
from drivers.cubemars.settings import CubemarsSettings
from drivers.joint import JointScale
from drivers.mit.actuator import chosen_ranges, reading_of

_OPENING_QUESTIONS = 6


class CubemarsDrive(ActuatorDrive[CubemarsActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

    def __init__(self, settings: CubemarsSettings, joint: JointScale) -> None:
        answer_s = 3 * settings.answer_timeout_s + 0.1
        family = Family(
            settings.device, "CubeMars", CubemarsActuator.modes, "", None, 2 * answer_s, _OPENING_QUESTIONS * answer_s
        )
        super().__init__(
            family,
            joint,
            lambda: on_bus(settings.bus, lambda port, leave: CubemarsActuator(port, settings, joint, leave)),
        )


def follow(settings: CubemarsSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveError: its ranges are not known, or the bus does not open.
    """
    written = settings.position_range_rad, settings.speed_range_rad_s, settings.torque_range_n_m
    ranges = chosen_ranges(settings.device, settings.model, protocol.MODELS, written)
    counts_rad = joint.counts_per_turn / (2.0 * pi)

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        # commands have the same identifier; none begins with the id unless its position is at the end of the range
        if len(heard.data) != 8 or heard.data[0] != settings.motor_id:
            return None
        found = protocol.feedback(heard.data, ranges)
        # whether it is powered is not in it: who moves is
        return reading_of(heard.at_s, found.motion, counts_rad, found.temperature_c, not found.fault, found.fault)

    names = f"CubeMars {settings.model or 'AK series actuator'}", settings.device
    return BusFollower(settings.bus, settings.answer_id, names, taken, joint)
