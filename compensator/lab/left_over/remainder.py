"""Whether what a model leaves is more than noise, whatever the catalogue says of it.

No model of what is missing is needed. What a mechanism leaves follows the motion, and so lies in the motion's band, a
quarter of the final cut-off (`bandwidth`); noise fills the whole band of the filter, and is no denser below than above.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.signal import sosfreqz

from compensator.lab.model.weights import bounded_influence
from compensator.lab.recordings.low_pass import filter_sections
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import FEWEST_ROWS, Dataset, Trial

BANDS = (0.0, 0.25, 0.5, 0.9)  # of the cut-off: the motion's, a gap, and the noise's
DENSER = 2.0  # in the motion's band than above: what coloured noise does not reach
SURE = 3.0  # standard deviations of that ratio's logarithm
LEAST_SHARE = 0.01  # of the effort: by so much friction differs from one stroke to the next without any cause


@dataclass(frozen=True, slots=True)
class Remainder:
    """What a model leaves.

    Attributes:
        share: its root mean square over the effort's.
        in_band: the same of what the motion's band holds beyond the density of the noise above.
        denser: its spectral density in the band of the motion over that above.
        certainty: logarithm of `denser` over that of noise alone, in standard deviations.
    """

    share: float
    in_band: float
    denser: float
    certainty: float

    @property
    def is_more_than_noise(self) -> bool:
        """Whether something is left to be explained."""
        return self.in_band > LEAST_SHARE and self.denser > DENSER and self.certainty > SURE


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
    denser, certainty, part = _in_band(dataset.cutoff_hz, [(at, own) for at, own, _ in spectra])
    whole = sum(total for _, _, total in spectra)
    in_band = share * float(np.sqrt(min(part / whole, 1.0))) if whole > 0.0 else 0.0
    return Remainder(share, in_band, denser, certainty)


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


def _in_band(cutoff_hz: float, spectra: list[tuple[FloatArray, FloatArray]]) -> tuple[float, float, float]:
    """Mean power in the motion's band over that in the noise's, over all trials, how sure it is more, and how much."""
    below, _, above = (
        np.concatenate(
            [power[(at >= low * cutoff_hz) & (at < high * cutoff_hz)] for at, power in spectra] or [np.empty(0)]
        )
        for low, high in pairwise(BANDS)
    )
    if not (len(below) and len(above)) or float(above.mean()) == 0.0:
        return np.nan, 0.0, 0.0
    denser = float(below.mean() / above.mean())
    # a power is exponentially distributed, so that a mean of n of them has a relative scatter of 1 / sqrt(n)
    certainty = float(np.log(max(denser, 1e-12)) / np.sqrt(1.0 / len(below) + 1.0 / len(above)))
    return denser, certainty, max(float(below.sum()) - len(below) * float(above.mean()), 0.0)
