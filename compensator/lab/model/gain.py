"""Held-out errors and gains with intervals, from whole trials drawn again."""

from dataclasses import dataclass

import numpy as np

from compensator.lab.model.held_out_error import HeldOut, on_even_terms
from compensator.lab.recordings.recording import FloatArray

RESAMPLES = 999
NO_SHARE = 1e-7  # less is rounding
CONFIDENCE = 0.90
NOTABLE = 0.01  # of a gain: how far it is from that of the errors beside it, before somebody wonders why


@dataclass(frozen=True, slots=True)
class Gain:
    """Relative fall of the held-out error, each row counting by how well it is known, with a 90 % interval.

    Attributes:
        value, low, high: of all independent units.
    """

    value: float
    low: float
    high: float

    def is_unlike(self, before: float, after: float) -> bool:
        """Whether it is notably not what the errors themselves have, each row counting alike, or they rise."""
        return before > 0.0 and (abs(self.value - (1.0 - after / before)) > NOTABLE or self.is_against(before, after))

    def is_against(self, before: float, after: float) -> bool:
        """Whether the errors themselves, as they are shown, go the other way."""
        return self.value * (before - after) < 0.0 and f"{before:.2%}" != f"{after:.2%}"

    def in_words(self, before: float, after: float) -> str:
        """The gain and its interval, beside relative errors."""
        evenly = ", each row counting by how well it is known" if self.is_unlike(before, after) else ""
        value, low, high = map(shown, (self.value, self.low, self.high))
        return f"gain {value}, 90 % interval {low} .. {high}{evenly}"


def shown(share: float) -> str:
    """A share as per cent, as the page has it: one under 5 % by its first two digits; nothing has no sign."""
    return f"{100.0 * share:.2g}%" if NO_SHARE < abs(share) < 0.05 else f"{round(share, 2) + 0.0:.0%}"


def held_out_gain(before: HeldOut, after: HeldOut, seed: int = 0) -> Gain:
    """The gain of `after` over `before`, both on the same rows, on even terms; trials are resampled in pairs."""
    powers = np.array([error.power_by_unit() for error in on_even_terms(before, after)])
    ratios = np.sqrt(_drawn(powers, seed))
    gains = 1.0 - ratios[1] / np.maximum(ratios[0], np.finfo(float).tiny)
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, high = np.quantile(gains[1:], [tail, 1.0 - tail])
    return Gain(float(gains[0]), float(low), float(high))


def predicts_better(one: HeldOut, other: HeldOut) -> bool:
    """Whether `one` has a lower held-out error than `other` for sure, both on the same rows, on even terms."""
    return held_out_gain(other, one).low > 0.0


def error_interval(error: HeldOut, seed: int = 0) -> tuple[float, float]:
    """90 % interval of a relative held-out error, from independent units drawn again."""
    powers = np.vstack([error.power_by_unit(), error.effort_power_by_unit()])
    totals = _drawn(powers, seed)[:, 1:]
    tail = 0.5 * (1.0 - CONFIDENCE)
    low, high = np.quantile(np.sqrt(totals[0] / np.maximum(totals[1], np.finfo(float).tiny)), [tail, 1.0 - tail])
    return float(low), float(high)


def _drawn(powers: FloatArray, seed: int) -> FloatArray:
    """Totals (2, 1 + RESAMPLES) of powers (2, units): first as measured, then with units drawn with replacement."""
    generator = np.random.default_rng(seed)
    units = powers.shape[1]
    counts = generator.multinomial(units, np.full(units, 1.0 / units), size=RESAMPLES)
    totals: FloatArray = powers @ np.vstack([np.ones(units), counts]).T
    return totals
