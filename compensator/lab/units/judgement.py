"""What units of one kind have in common in each quantity, what differs between them, and which are outliers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from compensator.lab.units.outliers import ALARM, Deviation, corrected_by_holm, deviations
from compensator.lab.units.quantities import Quantity
from compensator.lab.units.random_effects import Common, UnitValues, chance_of_one_value, common_of

PAIR = 2
PAIR_UPPER = 0.95  # of the interval of a difference, which holds with 90 %


@dataclass(frozen=True)
class Judged:
    """One quantity of all units.

    Attributes:
        quantity: which.
        common: of the units that are no outliers in it.
        chance: that these, if they were all the same, would differ as they do; corrected for all quantities.
        differs: whether that is below `ALARM`.
        deviations: of each unit that determines it, in order.
    """

    quantity: Quantity
    common: Common
    chance: float
    differs: bool
    deviations: list[Deviation]


def judge(quantities: Sequence[Quantity]) -> list[Judged]:
    """Every quantity, each of at least three units."""
    beside = deviations([one.values for one in quantities])
    inside = [
        one.values.of(np.array([not deviation.is_outlier for deviation in found]))
        for one, found in zip(quantities, beside, strict=True)
    ]
    chances = corrected_by_holm([chance_of_one_value(one) for one in inside], len(inside))
    return [
        Judged(quantity, common_of(kept), chance, chance < ALARM, found)
        for quantity, kept, chance, found in zip(quantities, inside, chances, beside, strict=True)
    ]


def difference(pair: UnitValues) -> tuple[float, float, float]:
    """The second of two units less the first, and the ends of its 90 % interval (Welch's t), in the quantity's unit.

    It needs no scatter between units, and says nothing of it.
    """
    found, variance = float(pair.value[1] - pair.value[0]), pair.variance
    freedom = float(variance.sum()) ** 2 / float((variance**2 / pair.freedom).sum())
    half = float(np.sqrt(variance.sum()) * stdtrit(freedom, PAIR_UPPER))
    return found, found - half, found + half
