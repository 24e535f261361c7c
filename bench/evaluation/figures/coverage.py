"""How sure a figure is: of a share of trials, and of the median of what seeds or rigs gave."""

from collections.abc import Iterable, Mapping, Sequence
from math import ceil, isfinite, nan
from statistics import fmean
from typing import Any, NamedTuple

from scipy.stats import beta, binom

from bench.config.reflected_load import arm_angle_rad, load_current_a
from bench.config.rig import Rig

TAIL = 0.025  # either side of 95 %
MOST = 0.9


class Share(NamedTuple):
    """So many of so many trials."""

    held: int
    trials: int

    def interval(self) -> tuple[float, float]:
        """What share may be behind it, 95 % (Clopper and Pearson); NaN without trials."""
        if self.trials == 0:
            return nan, nan
        held, missed = self.held, self.trials - self.held
        low = float(beta.ppf(TAIL, held, missed + 1)) if held else 0.0
        high = float(beta.ppf(1.0 - TAIL, held + 1, missed)) if missed else 1.0
        return low, high


def median_interval(numbers: Sequence[float]) -> tuple[float, float]:
    """What the median behind such numbers may be, at least 95 %; NaN of fewer than six.

    By order statistics (David and Nagaraja, "Order Statistics", 2003, section 7.1), whatever they are drawn from.
    """
    rank = int(binom.ppf(TAIL, len(numbers), 0.5)) if len(numbers) else 0
    if rank == 0:
        return nan, nan
    ordered = sorted(numbers)
    return ordered[rank - 1], ordered[-rank]


def reached_by_most(numbers: Sequence[float], low_is_bad: bool) -> float:
    """What nine of ten reach: the others are worse; NaN of none."""
    ordered = sorted(numbers, reverse=low_is_bad)
    return ordered[ceil(MOST * len(ordered)) - 1] if ordered else nan


def held(rows: Iterable[Mapping[str, Any]], rig: Rig) -> Share:
    """How many of the trials at rest state an interval that holds the truth; those without one do not count."""
    stated = [row for row in rows if row.get("load_interval_a") is not None]
    return Share(sum(_holds(row, rig) for row in stated), len(stated))


def _holds(row: Mapping[str, Any], rig: Rig) -> bool:
    low_a, high_a = row["load_interval_a"]
    return bool(low_a <= true_load_a(row, rig) <= high_a)


def true_load_a(row: Mapping[str, Any], rig: Rig) -> float:
    """Current of the known load [A], where the arm hung during the breakaways.

    The servo leaves the joint anywhere in its dead-band, and the load pulls the arm to one side of the free play.
    """
    about_a = load_current_a(row["load_kg"], row["angle_rad"], rig)
    stood_rad = fmean(one[3] if len(one) > 3 else nan for one in row.get("breakaways") or [[]])
    if not isfinite(stood_rad):
        return about_a
    return load_current_a(row["load_kg"], arm_angle_rad(stood_rad, about_a, rig), rig)
