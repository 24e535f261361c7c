"""The drive contract on one RobStride actuator, and a listener to one that another host drives."""

from math import pi

from drivers.actuator.drive import ActuatorDrive, Family
from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard, on_bus
from drivers.joint import JointScale
from drivers.mit.actuator import chosen_ranges, reading_of
from drivers.robstride import protocol
from drivers.robstride.actuator import RobstrideActuator
from drivers.robstride.protocol import Kind
from drivers.robstride.settings import RobstrideSettings

_OPENING_QUESTIONS = 16
_HOST_BITS = 0xFF


class RobstrideDrive(ActuatorDrive[RobstrideActuator]):
    """One actuator with its joint. It counts as the motor, its own gear included; `rig.gear` is what is behind it."""

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
        )


def follow(settings: RobstrideSettings, joint: JointScale) -> BusFollower:
    """Listen to it.

    Raises:
        DriveError: its ranges are not known, or the bus does not open.
    """
    written = settings.position_range_rad, settings.speed_range_rad_s, settings.torque_range_n_m
    ranges = chosen_ranges(settings.device, settings.model, protocol.MODELS, written)
    counts_rad = joint.counts_per_turn / (2.0 * pi)

    def taken(_port: CanPort, heard: Heard) -> Reading | None:
        if len(heard.data) != 8:
            return None
        found = protocol.feedback(heard.can_id, heard.data, ranges)
        is_on = found.mode == protocol.RUNS and not found.fault
        return reading_of(heard.at_s, found.motion, counts_rad, found.temperature_c, is_on, found.fault)

    return BusFollower(
        settings.bus,
        protocol.answer_id(Kind.FEEDBACK, settings.motor_id),
        (f"RobStride {settings.model or 'RS series actuator'}", settings.device),
        taken,
        joint,
        protocol.STATE_BITS | _HOST_BITS,
    )
