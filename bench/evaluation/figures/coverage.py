"""Whether the stated interval of I_load holds the truth, and how sure that share is."""

from collections.abc import Iterable, Mapping
from math import isfinite, nan
from statistics import fmean
from typing import Any, NamedTuple

from scipy.stats import beta

from bench.config.reflected_load import arm_angle_rad, load_current_a
from bench.config.rig import Rig

CONFIDENCE = 0.95


class Share(NamedTuple):
    """So many of so many trials."""

    held: int
    trials: int

    def interval(self) -> tuple[float, float]:
        """What share may be behind it, 95 % (Clopper and Pearson); NaN without trials."""
        if self.trials == 0:
            return nan, nan
        held, missed, tail = self.held, self.trials - self.held, (1.0 - CONFIDENCE) / 2.0
        low = float(beta.ppf(tail, held, missed + 1)) if held else 0.0
        high = float(beta.ppf(1.0 - tail, held + 1, missed)) if missed else 1.0
        return low, high


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
