"""A CubeMars actuator that another host drives."""

from math import pi

from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard
from drivers.cubemars import protocol
from drivers.cubemars.settings import CubemarsSettings
from drivers.joint import JointScale
from drivers.mit.actuator import chosen_ranges, reading_of


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
