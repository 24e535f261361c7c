"""What the values of columns say of their units: rates that add up, sampling that is possible, wraps."""

from collections.abc import Sequence

import numpy as np

from bench.recording_set.checks import HIGHEST_HZ, LOWEST_HZ
from bench.recording_set.units import UNITS, Unit
from compensator.lab.recordings.channel_checks import wrap_period
from compensator.lab.recordings.gaps import typical_step_s
from compensator.lab.recordings.recording import FloatArray

CLOCK_UNITS = ("s", "ms", "us", "ns")
EPOCH_S = (1e8, 1e10)  # since 1970: years 1973 to 2286
NEAR = 0.1  # relative: how near a slope has to be to a unit's factor
TOLD = 0.5  # squared correlation from which one column tells another's unit
FEWEST = 20
BLOCKS = 400  # of which rates are averaged: noise of one sample does no harm
GEAR = 0.01  # relative: how near a ratio of two rates has to be to one of gears
HALVES_TO = 50.0  # ratio up to which halves are told from whole numbers
LARGEST_GEAR = 1000.0
WHOLE = 0.999  # share of values that are whole numbers
SAME = 0.02  # relative: how near a period has to be to a known one
KNOWN_PERIODS = (360.0, 2.0 * np.pi, 1.0, 180.0, np.pi, *(float(2**bits) for bits in range(8, 25)))


def clock_units(values: FloatArray) -> list[str]:
    """Units in which a column of time gives a sampling that is possible, from seconds to nanoseconds."""
    known = np.unique(values[np.isfinite(values)])
    # of numbers beyond any date in nanoseconds even the steps may be none
    if len(known) < 3 or np.abs(known).max() > EPOCH_S[1] / UNITS["ns"].factor:
        return []
    steps = np.diff(known)
    step = typical_step_s(np.append(0.0, np.cumsum(steps)))
    start = abs(float(values[0]))
    found = []
    for name in CLOCK_UNITS:
        factor = UNITS[name].factor
        if start * factor > EPOCH_S[0] and not EPOCH_S[0] < start * factor < EPOCH_S[1]:
            continue
        if LOWEST_HZ <= 1.0 / (step * factor) <= HIGHEST_HZ / 4.0:
            found.append(name)
    epoch = [name for name in found if EPOCH_S[0] < start * UNITS[name].factor < EPOCH_S[1]]
    return epoch or found


def slope(time_s: FloatArray, position: FloatArray, velocity: FloatArray) -> float | None:
    """What the rate of the position is of the speed; None where they have little to do with each other."""
    known = np.isfinite(time_s) & np.isfinite(position) & np.isfinite(velocity)
    time_s, position, velocity = time_s[known], position[known], velocity[known]
    if len(time_s) < FEWEST:
        return None
    edges = np.unique(np.linspace(0, len(time_s) - 1, min(BLOCKS, len(time_s) // 2) + 1).astype(int))
    total = np.append(0.0, np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * np.diff(time_s)))
    ways, expected = np.diff(position[edges]), np.diff(total[edges])
    # a wrap is one block of many: the middle of the blocks tells the unit
    usual = np.abs(ways) <= 20.0 * np.median(np.abs(ways)) + 1e-12
    ways, expected = ways[usual], expected[usual]
    powers = float(ways @ ways), float(expected @ expected)
    if min(powers) == 0.0 or float(ways @ expected) ** 2 < TOLD * powers[0] * powers[1]:
        return None
    return float(ways @ expected) / powers[1]


def unit_by_slope(factor: float, units: Sequence[Unit]) -> Unit | None:
    """The unit whose SI factor is near to a slope; None where none is."""
    near = [unit for unit in units if abs(abs(factor) * unit.factor - 1.0) < NEAR]
    return near[0] if near else None


def gear_behind(ratio: float, known: float | None) -> float | None:
    """The gear ratio that a speed of the motor over that of the joint stands for; None where it is none.

    Args:
        ratio: of the two speeds, as measured.
        known: ratio of the gear, where it is told; without it, a whole or half-whole number is looked for.
    """
    step = 0.5 if ratio <= HALVES_TO else 1.0
    near = known if known is not None else round(ratio / step) * step
    return near if 1.0 < near <= LARGEST_GEAR and abs(ratio / near - 1.0) < GEAR else None


def are_whole(values: FloatArray) -> bool:
    """Whether a column holds whole numbers, as counts are, and more than a few."""
    known = values[np.isfinite(values)]
    return bool(len(known)) and float(np.mean(known == np.round(known))) > WHOLE and float(np.ptp(known)) > 50.0


def period_of(time_s: FloatArray, position: FloatArray) -> float | None:
    """The period at which a position wraps, in its own unit; a known one where it is near to it."""
    found = wrap_period(time_s, position)
    if found is None:
        return None
    near = [known for known in KNOWN_PERIODS if abs(found - known) < SAME * known]
    return near[0] if near else found


def rises(values: FloatArray) -> bool:
    """Whether a column never falls and mostly rises, as a time does; what counts 1, 2, 3 numbers the rows."""
    steps = np.diff(values[np.isfinite(values)])
    if len(steps) < FEWEST or not (steps >= 0.0).all() or (steps == 1.0).all():
        return False
    return float(np.mean(steps > 0.0)) > 0.5  # set points in steps stand still between them


def is_clock(values: FloatArray) -> bool:
    """Whether a column rises evenly, as a time does and nothing else of a joint."""
    steps = np.diff(values[np.isfinite(values)])
    return rises(values) and float(np.std(steps)) < 0.2 * float(np.mean(steps))
