"""A small move there and back, by drives that take positions and nothing else."""

from bench.config.configuration import BenchConfiguration
from bench.control.cycle import Action, Reading
from bench.errors import ExperimentError
from bench.experiments.analysis.commissioning_checks import Push
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.profile import Trapezoid
from drivers.contract import Command, Mode

_SPEED_RAD_S, _ACCELERATION_RAD_S2 = 0.3, 2.0  # slow: a hand at the emergency stop has time
_IN_PLACE_SHARE = 0.2  # of the way, that may be left in the end
_STILL_CYCLES = 10


def push_there_and_back(
    joint: Joint, excursion_rad: float, patience_s: float, configuration: BenchConfiguration
) -> Part[list[Push]]:
    """Two moves by the drive's own position loop; each set point is compared with the tracking limit.

    Args:
        joint: at rest, after its first reading.
        excursion_rad: way of each move.
        patience_s: longest wait at the end of a move for the joint to stand.
        configuration: of the bench.

    Raises:
        ExperimentError: the joint does not come to where it was asked to be.
    """
    start_rad = joint.reading.sample.position_rad
    ends_rad = (start_rad + excursion_rad, start_rad)
    pushes = []
    for direction, end_rad in zip((1, -1), ends_rad, strict=True):
        pushes.append(Push(direction, (yield from _move(joint, end_rad, patience_s, configuration)), []))
    return pushes


def _move(joint: Joint, end_rad: float, patience_s: float, configuration: BenchConfiguration) -> Part[list[Reading]]:
    period_s, begin_rad = configuration.control.period_s, joint.reading.sample.position_rad
    speed_rad_s = min(_SPEED_RAD_S, configuration.limits.speed_rad_s)
    way = Trapezoid(begin_rad, end_rad, speed_rad_s, _ACCELERATION_RAD_S2)
    readings: list[Reading] = []
    still, last_rad = 0, begin_rad
    while len(readings) * period_s < way.duration_s + patience_s:
        target_rad, _ = way.at((len(readings) + 1) * period_s)
        reading = yield from joint.act(Action(Command(Mode.POSITION, target_rad), target_rad))
        readings.append(reading)
        still, last_rad = still + 1 if reading.sample.position_rad == last_rad else 0, reading.sample.position_rad
        if still >= _STILL_CYCLES and len(readings) * period_s > way.duration_s and _arrived(last_rad, way, end_rad):
            return readings
    raise ExperimentError(
        f"the joint stands at {last_rad:.4g} rad {patience_s:g} s after a move from {begin_rad:.4g} rad to "
        f"{end_rad:.4g} rad has ended, or does not stand at all. Look at the gains of the drive's own position loop, "
        "its profile speed, the brake, and whether the arm is free"
    )


def _arrived(position_rad: float, way: Trapezoid, end_rad: float) -> bool:
    return abs(position_rad - end_rad) <= _IN_PLACE_SHARE * abs(end_rad - way.at(0.0).position_rad)
