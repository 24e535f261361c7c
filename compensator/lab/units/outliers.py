"""Which unit is an outlier in which quantity: each is held against what the others of its kind let expect.

An outlier would widen the scatter by which it is judged, so the unit is left out of it (the deleted residual of
regression diagnostics: Cook, Weisberg 1982). All units are judged in all quantities at once: the chances are corrected
by Holm (1979), and after each outlier the others are judged anew without it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtr, stdtrit

from compensator.lab.recordings.recording import BoolArray
from compensator.lab.units.random_effects import UPPER, UnitValues, scatter_squared, weighted_mean

FEWEST_LEFT = 3  # without an outlier: each of them still has two others, whose scatter can be known
ALARM = 0.05  # chance of one outlier or more among all units and quantities where there is none


@dataclass(frozen=True, slots=True)
class Deviation:
    """One unit in one quantity beside the other units.

    Attributes:
        by, low, high: value less the mean of the others, with its 95 % interval.
        expected_low, expected_high: where its measured value is expected with 95 %, from the others and its own error.
        chance: two-sided, of a deviation as large or larger, before correction.
        corrected: the same, corrected for all units and quantities.
        is_outlier: whether that is below `ALARM`.
    """

    by: float
    low: float
    high: float
    expected_low: float
    expected_high: float
    chance: float
    corrected: float = 1.0
    is_outlier: bool = False


@dataclass(frozen=True, slots=True)
class _Prediction:
    """What the others let expect: mean, its variance, variance of the value about it, degrees of freedom of that."""

    mean: float
    mean_variance: float
    variance: float
    freedom: float


def deviations(quantities: Sequence[UnitValues]) -> list[list[Deviation]]:
    """Every unit in every quantity, in the order given.

    Args:
        quantities: each of at least three units, which need not be the same ones.
    """
    kept = [np.ones(len(one.value), dtype=bool) for one in quantities]
    flagged: dict[tuple[int, int], tuple[float, float]] = {}
    tests, corrected = sum(len(one.value) for one in quantities), 0.0
    expected = _predictions(quantities, kept)
    chances = _chances(quantities, expected)
    while doubtful := {place: one for place, one in chances.items() if kept[place[0]].sum() > FEWEST_LEFT}:
        place = min(doubtful, key=doubtful.__getitem__)
        corrected = max(corrected, min(1.0, chances[place] * (tests - len(flagged))))
        if corrected >= ALARM:
            break
        flagged[place] = (chances[place], corrected)
        kept[place[0]][place[1]] = False
        chances = {key: one for key, one in chances.items() if key[0] != place[0]}
        anew = _predictions([quantities[place[0]]], [kept[place[0]]], place[0])
        expected |= anew
        chances |= _chances(quantities, anew)
    held = corrected_by_holm(list(chances.values()), tests - len(flagged))
    settled = flagged | {place: (chances[place], one) for place, one in zip(chances, held, strict=True)}
    return [
        [
            _deviation(
                one,
                unit,
                # others may have been found since it was flagged
                _expected(one, inside, unit) if (number, unit) in flagged else expected[number, unit],
                *settled[number, unit],
                (number, unit) in flagged,
            )
            for unit in range(len(one.value))
        ]
        for number, (one, inside) in enumerate(zip(quantities, kept, strict=True))
    ]


def _chances(
    quantities: Sequence[UnitValues], expected: Mapping[tuple[int, int], _Prediction]
) -> dict[tuple[int, int], float]:
    """Chance of each unit of which something is expected, by (quantity, unit)."""
    return {place: _chance(quantities[place[0]], place[1], one) for place, one in expected.items()}


def _predictions(
    quantities: Sequence[UnitValues], kept: Sequence[BoolArray], first: int = 0
) -> dict[tuple[int, int], _Prediction]:
    """Of each unit that is no outlier yet, by (quantity, unit); quantities are numbered from `first`."""
    return {
        (number, int(unit)): _expected(one, inside, int(unit))
        for number, (one, inside) in enumerate(zip(quantities, kept, strict=True), first)
        for unit in np.flatnonzero(inside)
    }


def corrected_by_holm(chances: Sequence[float], tests: int) -> list[float]:
    """Chances, corrected for how many there are.

    Args:
        chances: of each, before correction.
        tests: how many there are, at least these.
    """
    found, largest = [1.0] * len(chances), 0.0
    for rank, place in enumerate(np.argsort(chances)):
        largest = max(largest, min(1.0, chances[place] * (tests - rank)))
        found[place] = largest
    return found


def _chance(found: UnitValues, unit: int, expected: _Prediction) -> float:
    size = abs(float(found.value[unit]) - expected.mean) / np.sqrt(expected.variance)
    return float(2.0 * stdtr(expected.freedom, -size))


def _deviation(
    found: UnitValues, unit: int, expected: _Prediction, chance: float, corrected: float, is_outlier: bool
) -> Deviation:
    by, own2 = float(found.value[unit]) - expected.mean, float(found.variance[unit])
    # the others' mean is known by as many units, the own value by as many trials
    count = len(found.value) - 1.0
    both = own2 + expected.mean_variance
    freedom = both**2 / (own2**2 / found.freedom[unit] + expected.mean_variance**2 / max(count - 1.0, 1.0))
    half = float(stdtrit(freedom, UPPER)) * np.sqrt(both)
    reach = float(stdtrit(expected.freedom, UPPER)) * np.sqrt(expected.variance)
    return Deviation(
        by, by - half, by + half, expected.mean - reach, expected.mean + reach, chance, corrected, is_outlier
    )


def _expected(found: UnitValues, kept: BoolArray, unit: int) -> _Prediction:
    """From all that are kept but the unit itself.

    The degrees of freedom are Satterthwaite's (1946): what lies between the others is known by their number less one,
    the unit's own error by its trials.
    """
    inside = kept.copy()
    inside[unit] = False
    others = found.of(inside)
    count = len(others.value)
    scatter2 = scatter_squared(others, count - 1.0)
    mean, mean_variance = weighted_mean(others, scatter2)
    own2 = float(found.variance[unit])
    variance = scatter2 + own2 + mean_variance
    known = (scatter2 + float(np.mean(others.variance))) * (1.0 + 1.0 / count)
    freedom = variance**2 / (known**2 / (count - 1.0) + own2**2 / float(found.freedom[unit]))
    return _Prediction(mean, mean_variance, variance, freedom)
