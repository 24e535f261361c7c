"""Load and friction of a joint at rest from zero-speed searches, corrected where known loads have told how."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, isnan

from bench.config.configuration import BenchConfiguration
from bench.experiments.parts.search import Found
from compensator.line_fit import Interval
from compensator.rest.breakaway_fit import BreakawayFit, fit


@dataclass(frozen=True, slots=True)
class RestFinding:
    """What searches in a row found.

    Attributes:
        min_current_a, max_current_a: at which the joint lets go, at rate 0 where two rates tell.
        load_current_a, friction_current_a: eqs (9), (10), corrected.
        load_interval_a, friction_interval_a: 95 %, [low, high]; None where the searches do not tell.
        position_rad: where the joint stood, by the sensor, mean of all breakaways; NaN where the search kept none.
    """

    min_current_a: float
    max_current_a: float
    load_current_a: float
    friction_current_a: float
    load_interval_a: list[float] | None
    friction_interval_a: list[float] | None
    position_rad: float

    @property
    def half_width_a(self) -> float:
        """Half of the interval of the load, by its longer side [A]; inf where the searches do not tell."""
        if self.load_interval_a is None:
            return inf
        low_a, high_a = self.load_interval_a
        return max(high_a - self.load_current_a, self.load_current_a - low_a)


def finding(found: Sequence[Found], configuration: BenchConfiguration) -> RestFinding:
    """Of searches that each have an estimate."""
    plain = fitted(found)
    mean_a, half_a = plain.load_current_a.value, plain.friction_current_a.value
    load, friction = plain.load_current_a, plain.friction_current_a
    if configuration.rest is not None:
        load, friction = configuration.rest.calibration().estimate(plain)
    return RestFinding(
        mean_a - half_a, mean_a + half_a, load.value, friction.value, _ends(load), _ends(friction), plain.position_rad
    )


def fitted(found: Sequence[Found]) -> BreakawayFit:
    """All breakaways of the searches together, without corrections."""
    return fit([breakaway for one in found for breakaway in one.breakaways])


def _ends(interval: Interval) -> list[float] | None:
    return None if isnan(interval.low) else [interval.low, interval.high]
