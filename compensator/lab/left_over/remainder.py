"""Whether what a model leaves is more than noise, whatever the catalogue says of it.

No model of what is missing is needed. What a mechanism leaves follows the motion, and so lies in the motion's band, a
quarter of the final cut-off (`bandwidth`); noise fills the whole band of the filter, and is no denser below than above.
Nor has noise a resonance: a band that is denser than one below and one above is of something that swings, as a link, a
belt or a load on a cable does when the motion strikes it.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.signal import sosfreqz

from compensator.lab.left_over.lines import TINY
from compensator.lab.model.weights import bounded_influence
from compensator.lab.recordings.low_pass import filter_sections
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import FEWEST_ROWS, Dataset, Trial

BANDS = (0.0, 0.25, 0.5, 0.9)  # of the cut-off: the motion's, a gap, and the noise's
NARROW = 0.1  # of the cut-off: a band for a resonance, each half of it beyond the one before
DENSER = 2.0  # in the motion's band than above: what coloured noise does not reach
SURE = 3.0  # standard deviations of that ratio's logarithm
LEAST_SHARE = 0.01  # of the effort: by so much friction differs from one stroke to the next without any cause


@dataclass(frozen=True, slots=True)
class Resonance:
    """A band in which the residual is denser than below and above.

    Attributes:
        frequency_hz: middle of the band, as the servo holds the joint.
        denser: its density over the larger of the lowest ones on either side.
    """

    frequency_hz: float
    denser: float


@dataclass(frozen=True, slots=True)
class Remainder:
    """What a model leaves.

    Attributes:
        share: its root mean square over the effort's.
        in_band: the same of what the motion's band holds beyond the density of the noise above.
        denser: its spectral density in the band of the motion over that above.
        certainty: logarithm of `denser` over that of noise alone, in standard deviations.
        resonance: where it is denser than below and above; None where it is not for sure.
    """

    share: float
    in_band: float
    denser: float
    certainty: float
    resonance: Resonance | None = None

    @property
    def is_more_than_noise(self) -> bool:
        """Whether something is left to be explained."""
        follows = self.in_band > LEAST_SHARE and self.denser > DENSER and self.certainty > SURE
        return follows or self.resonance is not None


def remainder_of(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> Remainder:
    """Judge what a model leaves; a few wild rows, as of a voltage that nothing determines, do not make it so.

    Args:
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        rows: chosen, shape (N,).
    """
    residual = residual * bounded_influence(residual)
    trials = dataset.trial_index[rows]
    spectra = [
        _spectrum(dataset, trial, residual[trials == index])
        for index, trial in enumerate(dataset.trials)
        if int((trials == index).sum()) >= FEWEST_ROWS
    ]
    effort = dataset.effort[rows]
    power = float(effort @ effort)
    share = float(np.sqrt(residual @ residual / power)) if power > 0.0 else 0.0
    at_hz, powers = (np.concatenate([one[part] for one in spectra] or [np.empty(0)]) for part in (0, 1))
    denser, certainty, part = _in_band(dataset.cutoff_hz, at_hz, powers)
    whole = sum(total for _, _, total in spectra)
    in_band = share * float(np.sqrt(min(part / whole, 1.0))) if whole > 0.0 else 0.0
    # each trial counts alike, so that it rings in most of them
    even = np.concatenate([power / max(float(power.mean()), TINY) for _, power, _ in spectra if len(power)] or [powers])
    # so little may be of the motion, whose own frequencies most trials can share
    resonance = _resonance(dataset.cutoff_hz, at_hz, even) if share > LEAST_SHARE else None
    return Remainder(share, in_band, denser, certainty, resonance)


def _spectrum(dataset: Dataset, trial: Trial, residual: FloatArray) -> tuple[FloatArray, FloatArray, float]:
    """Frequencies [Hz] within the filter's band, and the residual's power there, the filter's own slope taken off.

    Last, its power at all frequencies, as it is.
    """
    times_s, rate_hz = dataset.time_of(trial), trial.signals.rate_hz
    period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 1.0 / rate_hz
    frequencies: FloatArray = np.asarray(np.fft.rfftfreq(len(residual), period_s)[1:], dtype=np.float64)
    power: FloatArray = np.abs(np.fft.rfft(residual - residual.mean())[1:]) ** 2
    whole = float(power.sum())
    inside = frequencies < BANDS[-1] * min(dataset.cutoff_hz, 0.5 / period_s)
    frequencies, power = frequencies[inside], power[inside]
    if dataset.cutoff_hz < 0.49 * rate_hz:
        sections, _ = filter_sections(dataset.cutoff_hz, rate_hz)
        gain = np.abs(sosfreqz(sections, worN=frequencies, fs=rate_hz)[1]) ** 2  # there and back
        power = power / gain**2
    return frequencies, power, whole


def _in_band(cutoff_hz: float, at_hz: FloatArray, powers: FloatArray) -> tuple[float, float, float]:
    """Mean power in the motion's band over that in the noise's, over all trials, how sure it is more, and how much."""
    below, _, above = (powers[(at_hz >= low * cutoff_hz) & (at_hz < high * cutoff_hz)] for low, high in pairwise(BANDS))
    if not (len(below) and len(above)) or float(above.mean()) == 0.0:
        return np.nan, 0.0, 0.0
    denser = float(below.mean() / above.mean())
    certainty = _certainty(denser, len(below), len(above))
    return denser, certainty, max(float(below.sum()) - len(below) * float(above.mean()), 0.0)


def _certainty(denser: float, some: int, others: int) -> float:
    """Logarithm of a ratio of two mean powers in standard deviations.

    A power is exponentially distributed, so that a mean of n of them has a relative scatter of 1 / sqrt(n).
    """
    return float(np.log(max(denser, 1e-12)) / np.sqrt(1.0 / some + 1.0 / others))


def _resonance(cutoff_hz: float, at_hz: FloatArray, powers: FloatArray) -> Resonance | None:
    """The band that stands out most from the lowest ones below and above it; None where none does for sure."""
    lows = np.arange(0.0, BANDS[-1] - NARROW, 0.5 * NARROW) * cutoff_hz
    inside = [powers[(at_hz >= low) & (at_hz < low + NARROW * cutoff_hz)] for low in lows]
    if not all(len(one) for one in inside):
        return None
    counts, means = np.array([len(one) for one in inside]), np.array([one.mean() for one in inside])
    best: Resonance | None = None
    for at in range(1, len(lows) - 1):
        sides = (int(np.argmin(means[:at])), at + 1 + int(np.argmin(means[at + 1 :])))
        floor = max(sides, key=lambda side: means[side])
        denser = float(means[at] / max(means[floor], TINY))
        sure = _certainty(denser, counts[at], counts[floor]) > SURE
        if sure and denser > (DENSER if best is None else best.denser):
            best = Resonance(float(lows[at] + 0.5 * NARROW * cutoff_hz), denser)
    return best


def ringing_in_words(resonance: Resonance) -> str:
    """Where it stands out, and where to look."""
    how = f"{resonance.denser:.2g} times as dense as below and above"
    where = "look for what swings when the motion strikes it, as a link, a belt or a load that bends"
    return f"rings at about {resonance.frequency_hz:.2g} Hz in closed loop, {how}: {where}"
