"""Torque per current from a weight that is known, at several angles: they check each other."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sin, tan

from bench.commission.questions import CommissionError
from bench.config.reflected_load import STANDARD_GRAVITY_M_S2
from bench.json_types import Values, number, numbers
from compensator.line_fit import Interval

SCALE_SHARE = 0.08  # by which the angles may disagree
MOMENT_SURE = 2.0  # half widths of its interval by which a moment shows
ZERO_RAD = 0.04  # how well straight down is seen
EMF_SHARE = 0.3  # by which torque per current and back-EMF per speed may: they are one constant but for the gear's loss


@dataclass(frozen=True, slots=True)
class Weighed:
    """What a known weight told.

    Attributes:
        torque_n_m_a: torque at the joint per motor current.
        own_moment_kg_m: of the arm without load; 0 where it does not show.
        breakaway_a: friction at rest without and with the weight.
        gravity_a: current that holds weight and arm at the larger angle.
    """

    torque_n_m_a: Interval
    own_moment_kg_m: Interval
    breakaway_a: tuple[float, float]
    gravity_a: float

    @property
    def has_own_moment(self) -> bool:
        """Whether the moment of the bare arm is surer than half of it."""
        own = self.own_moment_kg_m
        return abs(own.value) > MOMENT_SURE * abs(own.high - own.value)


@dataclass(frozen=True, slots=True)
class _AtRest:
    load_a: float
    half_a: float
    friction_a: float
    angle_rad: float


def weighed(rows: Sequence[Values], load_kg: float, length_m: float) -> Weighed:
    """From the rows of a load sweep: no load and the weight, at each angle.

    Args:
        rows: as the sweep's results hold them.
        load_kg: of the weight.
        length_m: axis to weight.

    Raises:
        CommissionError: a search failed, or the angles contradict each other.
    """
    angles_rad = sorted({number(row["angle_rad"]) for row in rows})
    constants = []
    for angle_rad in angles_rad:
        bare, loaded = (_at_rest(rows, angle_rad, hung_kg) for hung_kg in (0.0, load_kg))
        constants.append(_torque_per_current(bare, loaded, load_kg * length_m))
    for angle_rad, one in zip(angles_rad, constants, strict=True):
        _compare(one, angle_rad, constants[-1], angles_rad[-1])
    return _of(bare, loaded, constants[-1])


def _compare(one: Interval, angle_rad: float, largest: Interval, largest_rad: float) -> None:
    """Torque per current is one number at all angles, where the angles are what the counts say."""
    allowed = SCALE_SHARE + (one.high - one.low) / one.value / 2.0
    allowed += ZERO_RAD * abs(1.0 / tan(angle_rad) - 1.0 / tan(largest_rad))  # where "straight down" was not
    if abs(one.value / largest.value - 1.0) > allowed:
        raise CommissionError(
            f"by the weight 1 A gives {one.value:.3g} N m at {angle_rad:.2f} rad and {largest.value:.3g} N m at "
            f"{largest_rad:.2f} rad; one number is wanted, within {allowed:.2g}. The angles are not what "
            "the counts say: was the arm straight down at first, and was it turned by the angle that was answered?"
        )


def _of(bare: _AtRest, loaded: _AtRest, torque: Interval) -> Weighed:
    per_a = torque.value / (STANDARD_GRAVITY_M_S2 * sin(bare.angle_rad))
    own = Interval(bare.load_a * per_a, (bare.load_a - bare.half_a) * per_a, (bare.load_a + bare.half_a) * per_a)
    return Weighed(torque, own, (bare.friction_a, loaded.friction_a), loaded.load_a)


def check_back_emf(torque: Interval, back_emf: Interval) -> None:
    """Compare torque per current with back-EMF per speed of the joint: in SI they are one number.

    Raises:
        CommissionError: they differ by more than a gear loses.
    """
    if back_emf.note or back_emf.value != back_emf.value:
        return
    share, allowed = torque.value / back_emf.value, EMF_SHARE + (back_emf.high - back_emf.low) / back_emf.value / 2.0
    if abs(share - 1.0) > allowed:
        raise CommissionError(
            f"the weight says {torque.value:.3g} N m/A at the joint, the back-EMF {back_emf.value:.3g} V s/rad, which "
            f"should be one number within {allowed:.2g}. Is the arm as long and the weight as heavy as was answered, "
            "and is the drive's current in A?"
        )


def _torque_per_current(bare: _AtRest, loaded: _AtRest, moment_kg_m: float) -> Interval:
    current_a, half_a = loaded.load_a - bare.load_a, hypot(loaded.half_a, bare.half_a)
    if current_a <= 2.0 * half_a:
        raise CommissionError(
            f"the weight takes {current_a:.3g} A more than the bare arm, and that is sure to {half_a:.2g} A only; hang "
            "more, or farther out"
        )
    torque_n_m = STANDARD_GRAVITY_M_S2 * moment_kg_m * sin(loaded.angle_rad)
    value, low, high = (torque_n_m / (current_a + side * half_a) for side in (0.0, 1.0, -1.0))
    return Interval(value, low, high)


def _at_rest(rows: Sequence[Values], angle_rad: float, load_kg: float) -> _AtRest:
    """Mean of the repeats that found something."""
    repeats = [row for row in rows if row["angle_rad"] == angle_rad and row["load_kg"] == load_kg]
    found = [row for row in repeats if row["load_current_a"] is not None]
    if not found:
        raise CommissionError(
            f"the search at {angle_rad:.2f} rad with {1e3 * load_kg:g} g ended without an estimate: "
            f"{repeats[0]['search_failure']}. Look at the free travel of the arm, and at the load"
        )
    halves_a = [(high_a - low_a) / 2.0 for low_a, high_a in map(_ends_a, found)]
    load_a, friction_a, stood_rad = (
        sum(numbers(found, name)) / len(found) for name in ("load_current_a", "friction_current_a", "arm_angle_rad")
    )
    return _AtRest(load_a, max(halves_a), friction_a, stood_rad)


def _ends_a(row: Values) -> tuple[float, float]:
    ends = row["load_interval_a"]
    if not isinstance(ends, list | tuple):
        return 0.0, 0.0
    return number(ends[0]), number(ends[1])
