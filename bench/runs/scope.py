"""What can be compensated on a joint, and what cannot: by its drive, its travel and its rig, before anything moves.

Each rule is arithmetic on what is known: which demands the drive takes, which effort it tells, how far the joint may
turn. A quantity that cannot be told apart is said so here, and not after an afternoon of trials.
"""

from collections.abc import Iterator
from enum import StrEnum
from math import cos, degrees, isfinite, pi, sin, sqrt
from typing import NamedTuple

from bench.config.configuration import BenchConfiguration
from bench.control.servo import current_servo
from drivers.contract import Description, Mode

_STEADY_S = 0.2  # at one speed, to be a point of a friction curve
_LEAST_SWING = 0.5  # of the sine of the angle, for a weight to be told from a constant torque
_LEAST_TURNS, _ENOUGH_TURNS = 1.0, 2.0  # of the motor, for what goes round with it
_LEAST_STEPS = 3.0  # of the position, in a free play that is to be seen


class Answer(StrEnum):
    """Whether it can be done."""

    YES = "yes"
    IN_PART = "in part"
    NO = "no"


class Scope(NamedTuple):
    """One thing that people want to compensate."""

    what: str
    answer: Answer
    why: str


def scope_of(configuration: BenchConfiguration, drive: Description) -> tuple[Scope, ...]:
    """What can be compensated on this joint with this drive, and what cannot."""
    return tuple(_scopes(configuration, drive))


def setting_to_add(configuration: BenchConfiguration, drive: Description) -> str:
    """What the bench's file has to say for the effort to be told; "" where it is told, or no setting would help."""
    if drive.untold is not None:
        return drive.untold.remedy
    if _effort(configuration, drive) or "duty" not in drive.measured:
        return ""
    wanted = "resistance_ohm and back_emf_v_s_rad in [rig.motor], ratio in [rig.gear]"
    return f"nothing tells the effort; set {wanted}, as far as they are not there"


def _scopes(configuration: BenchConfiguration, drive: Description) -> Iterator[Scope]:
    effort = _effort(configuration, drive)
    no_effort = "" if effort else _no_effort(drive)
    if not drive.modes:
        no_effort = _no_push(drive)  # nothing moves
    yield _compensation(drive, effort, no_effort)
    yield _at_rest(drive)
    yield _in_motion(configuration, no_effort)
    yield _weight(configuration, no_effort)
    yield _round_the_motor(configuration)
    yield _free_play(configuration, drive)
    yield _temperature(drive)
    zero = _zero(configuration)
    if zero is not None:
        yield zero


def _effort(configuration: BenchConfiguration, drive: Description) -> str:
    """Where the effort comes from, in words; "" where nothing tells it."""
    if "current_a" in drive.measured:
        return "the current that it measures"
    if "torque_n_m" in drive.measured:
        return "the torque that it tells"
    known = "duty" in drive.measured and current_servo(configuration.rig) is not None
    return "duty, speed and the rig's motor constants, paper, eq. (3)" if known else ""


def _no_effort(drive: Description) -> str:
    """Why nothing tells the effort, and what to do."""
    if drive.untold is not None and drive.untold.tells:
        return f"nothing tells its effort: {drive.untold.remedy}"
    if "duty" not in drive.measured:
        return "nothing tells its effort: the drive measures neither current nor torque nor duty"
    return "nothing tells its effort; add motor constants and supply to the rig"


def _no_push(drive: Description) -> str:
    """Why the drive cannot be asked for an effort, and what to do; "" where it can."""
    if drive.modes - {Mode.POSITION}:
        return ""
    takes = "it takes positions alone" if drive.modes else "it has no mode that can be used"
    if drive.untold is not None and drive.untold.takes:
        return f"{takes} as it is set up now: {drive.untold.remedy}"
    return takes


def _compensation(drive: Description, effort: str, no_effort: str) -> Scope:
    what = "friction taken off what the joint is asked for, and off what it tells"
    no_push = _no_push(drive)
    if no_push and (not drive.modes or (drive.untold is not None and drive.untold.takes)):
        return Scope(what, Answer.NO, no_push)
    if no_push:
        return Scope(
            what,
            Answer.NO,
            "it takes positions alone: nothing can be added to its effort. Its friction can be known, from what it "
            "reports while it moves, and not be taken away",
        )
    if no_effort:
        return Scope(what, Answer.NO, no_effort)
    return Scope(what, Answer.YES, f"by {effort}")


def _at_rest(drive: Description) -> Scope:
    what = "friction at rest (breakaway)"
    if no_push := _no_push(drive):
        return Scope(what, Answer.NO, f"a push of known size is wanted, and {no_push}")
    return Scope(what, Answer.YES, "by pushes that rise until it moves")


def _in_motion(configuration: BenchConfiguration, no_effort: str) -> Scope:
    what = "friction in motion"
    if no_effort:
        return Scope(what, Answer.NO, no_effort)
    reach_rad_s, highest_rad_s = _reach_rad_s(configuration), configuration.limits.speed_rad_s
    if reach_rad_s >= highest_rad_s:
        return Scope(what, Answer.YES, f"up to the highest speed that is allowed, {highest_rad_s:.3g} rad/s")
    return Scope(
        what,
        Answer.IN_PART,
        f"up to {reach_rad_s:.2g} rad/s: within {degrees(_travel_rad(configuration)):.0f} degrees it has no longer "
        f"stretch at one speed. From there to {highest_rad_s:.3g} rad/s no friction is seen; do not extrapolate",
    )


def _weight(configuration: BenchConfiguration, no_effort: str) -> Scope:
    what = "weight of arm and load, told from a constant torque"
    if no_effort:
        return Scope(what, Answer.NO, no_effort)
    swing = _swing(configuration.limits.position_min_rad, configuration.limits.position_max_rad)
    if swing >= _LEAST_SWING:
        return Scope(what, Answer.YES, f"the lever changes by {swing:.0%} of its length over the travel")
    return Scope(
        what,
        Answer.NO,
        f"the lever changes by {swing:.0%} of its length over the travel: weight, offset and friction that differs "
        "with the direction look alike. Hang two known loads, or allow more travel",
    )


def _round_the_motor(configuration: BenchConfiguration) -> Scope:
    what = "friction and ripple that go round with the motor"
    ratio = configuration.rig.gear.ratio
    if ratio is None:
        return Scope(what, Answer.NO, "the rig leaves out gear.ratio")
    turns = _travel_rad(configuration) * ratio / (2.0 * pi)
    if turns < _LEAST_TURNS:
        return Scope(what, Answer.NO, f"the motor turns {turns:.2g} times over the travel: no place comes twice")
    answer = Answer.YES if turns >= _ENOUGH_TURNS else Answer.IN_PART
    return Scope(what, answer, f"the motor turns {turns:.3g} times over the travel")


def _free_play(configuration: BenchConfiguration, drive: Description) -> Scope:
    what = "free play of the gear"
    step_rad, play_rad = drive.resolution.get("position_rad"), configuration.rig.gear.backlash_rad
    if no_push := _no_push(drive):
        return Scope(what, Answer.NO, f"it is found by pushes to and fro, and {no_push}")
    if play_rad is None or step_rad is None or not isfinite(step_rad):
        return Scope(what, Answer.YES, "from one step of the position on; the rig says nothing of its size")
    if play_rad < _LEAST_STEPS * step_rad:
        return Scope(
            what,
            Answer.NO,
            f"{play_rad:.2g} rad are {play_rad / step_rad:.1f} steps of the position, which is too coarse",
        )
    return Scope(what, Answer.YES, f"{play_rad:.2g} rad are {play_rad / step_rad:.0f} steps of the position")


def _temperature(drive: Description) -> Scope:
    what = "friction that changes with temperature"
    if "temperature_c" in drive.measured:
        return Scope(
            what, Answer.IN_PART, "by the drive's temperature, which follows that of winding and lubricant late"
        )
    return Scope(what, Answer.NO, "it measures none: what changes is seen over time alone")


def _zero(configuration: BenchConfiguration) -> Scope | None:
    """None where the arm may hang straight down."""
    limits = configuration.limits
    if limits.position_min_rad <= 0.0 <= limits.position_max_rad:
        return None
    return Scope(
        "angle 0 by an arm that hangs straight down",
        Answer.NO,
        f"0 is not within its limits, {limits.position_range()} rad: hold it at a known angle, such as an end stop, "
        "and 'friction-bench doctor --set-zero --at-deg ANGLE'",
    )


def _travel_rad(configuration: BenchConfiguration) -> float:
    limits = configuration.limits
    return limits.position_max_rad - limits.position_min_rad


def _reach_rad_s(configuration: BenchConfiguration) -> float:
    """The highest speed at which a stroke over the travel, begun and ended at rest, is steady for long enough."""
    travel_rad, acceleration = _travel_rad(configuration), configuration.motion.acceleration_rad_s2
    return 0.5 * acceleration * (sqrt(_STEADY_S**2 + 4.0 * travel_rad / acceleration) - _STEADY_S)


def _swing(low_rad: float, high_rad: float) -> float:
    """How much the sine of the angle varies within a range."""
    sines = [sin(low_rad), sin(high_rad)]
    first = int(-(-(low_rad - 0.5 * pi) // pi))  # peaks are at pi/2 + n pi
    place_rad = 0.5 * pi + first * pi
    while place_rad <= high_rad:
        sines.append(cos(first * pi))
        first, place_rad = first + 1, place_rad + pi
    return max(sines) - min(sines)
