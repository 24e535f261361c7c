"""Whether what a model leaves is more than noise, whatever the catalogue says of it.

No model of what is missing is needed. What a mechanism leaves follows the motion, and so lies in the motion's band, a
quarter of the final cut-off (`bandwidth`); noise fills the whole band of the filter, and is no denser below than above.
What swings by itself, as a supply that ripples, holds more of one frequency than chance gives it (Fisher 1929). The
noise itself is not white: time stamps that jitter move the position, and its second derivative is the steeper the
higher the frequency. So each frequency is held against the noise around it, in all trials.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.signal import sosfreqz

from compensator.lab.model.weights import bounded_influence
from compensator.lab.recordings.processing import filter_sections
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.regimes import BoolArray
from compensator.lab.rows.dataset import Dataset, Trial

BANDS = (0.0, 0.25, 0.5, 0.9)  # of the cut-off: the motion's, a gap, and the noise's
DENSER = 2.0  # in the motion's band than above: what coloured noise does not reach
SURE = 3.0  # standard deviations of that ratio's logarithm
LEAST_SHARE = 0.01  # of the effort: by so much friction differs from one stroke to the next without any cause
CHANCE = 0.01  # of so strong a frequency in a trial that holds only noise
MOST = 0.5  # share of the trials
AROUND_HZ = 1.0  # to both sides: noise is smooth over so much, and what swings is narrower
FEWEST_ROWS = 20
ALIKE = 0.1  # relative spread of the frequencies of one source


@dataclass(frozen=True, slots=True)
class Remainder:
    """What a model leaves.

    Attributes:
        share: its root mean square over the effort's.
        denser: its spectral density in the band of the motion over that above.
        certainty: logarithm of `denser` over that of noise alone, in standard deviations.
        swinging: share of the trials in which one frequency stands out.
        frequency_hz: of it, where it is the same in all of these; NaN where it is not.
    """

    share: float
    denser: float
    certainty: float
    swinging: float
    frequency_hz: float

    @property
    def is_more_than_noise(self) -> bool:
        """Whether something is left to be explained."""
        follows_motion = self.denser > DENSER and self.certainty > SURE
        return self.share > LEAST_SHARE and (follows_motion or self.swinging > MOST)


def remainder_of(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> Remainder:
    """Judge what a model leaves; a few wild rows, as of a voltage that nothing determines, do not make it so.

    Args:
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        rows: chosen, shape (N,).
    """
    residual = residual * bounded_influence(residual, np.ones(len(residual)))
    trials = dataset.trial_index[rows]
    spectra = [
        _spectrum(dataset, trial, residual[trials == index])
        for index, trial in enumerate(dataset.trials)
        if int((trials == index).sum()) >= FEWEST_ROWS
    ]
    found = [_strongest(*spectrum) for spectrum in _over_noise(spectra)]
    clear = [frequency for chance, frequency in found if chance <= CHANCE]
    effort = dataset.effort[rows]
    power = float(effort @ effort)
    share = float(np.sqrt(residual @ residual / power)) if power > 0.0 else 0.0
    denser, certainty = _in_band(dataset.cutoff_hz, spectra)
    return Remainder(share, denser, certainty, len(clear) / len(found) if found else 0.0, _common(clear))


def _spectrum(dataset: Dataset, trial: Trial, residual: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] within the filter's band, and the residual's power there, the filter's own slope taken off."""
    times_s, rate_hz = dataset.time_of(trial), trial.signals.rate_hz
    period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else 1.0 / rate_hz
    frequencies: FloatArray = np.asarray(np.fft.rfftfreq(len(residual), period_s)[1:], dtype=np.float64)
    power: FloatArray = np.abs(np.fft.rfft(residual - residual.mean())[1:]) ** 2
    inside = frequencies < BANDS[-1] * min(dataset.cutoff_hz, 0.5 / period_s)
    frequencies, power = frequencies[inside], power[inside]
    if dataset.cutoff_hz < 0.49 * rate_hz:
        sections, _ = filter_sections(dataset.cutoff_hz, rate_hz)
        gain = np.abs(sosfreqz(sections, worN=frequencies, fs=rate_hz)[1]) ** 2  # there and back
        power = power / gain**2
    return frequencies, power


def _in_band(cutoff_hz: float, spectra: list[tuple[FloatArray, FloatArray]]) -> tuple[float, float]:
    """Mean power in the motion's band over that in the noise's, over all trials, and how sure it is more."""
    below, _, above = (
        np.concatenate(
            [power[(at >= low * cutoff_hz) & (at < high * cutoff_hz)] for at, power in spectra] or [np.empty(0)]
        )
        for low, high in pairwise(BANDS)
    )
    if not (len(below) and len(above)) or float(above.mean()) == 0.0:
        return np.nan, 0.0
    denser = float(below.mean() / above.mean())
    # a power is exponentially distributed, so that a mean of n of them has a relative scatter of 1 / sqrt(n)
    return denser, float(np.log(max(denser, 1e-12)) / np.sqrt(1.0 / len(below) + 1.0 / len(above)))


def _over_noise(spectra: list[tuple[FloatArray, FloatArray]]) -> list[tuple[FloatArray, FloatArray]]:
    """Each spectrum over that of the noise: the median around a frequency, of all trials, which no line moves."""
    spectra = [(at, power / power.mean()) for at, power in spectra if len(power) and power.mean() > 0.0]
    if not spectra:
        return []
    every, powers = (np.concatenate(parts) for parts in zip(*spectra, strict=True))
    centres = np.arange(0.0, every.max() + AROUND_HZ, 0.5 * AROUND_HZ)
    near = [np.abs(every - centre) <= AROUND_HZ for centre in centres]
    known = np.array([inside.any() for inside in near])
    floor = np.array([np.median(powers[inside]) for inside in near if inside.any()])
    logarithm = np.log(np.maximum(floor, np.finfo(float).tiny))
    return [(at, power / np.exp(np.interp(at, centres[known], logarithm))) for at, power in spectra]


def _strongest(frequencies_hz: FloatArray, power: FloatArray) -> tuple[float, float]:
    """The chance of a frequency as strong as the strongest, in noise alone, and that frequency [Hz]."""
    whole = float(power.sum())
    if whole == 0.0:
        return 1.0, np.nan
    best = int(np.argmax(power))
    chance = len(power) * (1.0 - float(power[best]) / whole) ** (len(power) - 1)
    return min(chance, 1.0), float(frequencies_hz[best])


def _common(frequencies_hz: list[float]) -> float:
    if len(frequencies_hz) < 3:
        return np.nan
    middle = float(np.median(frequencies_hz))
    return middle if float(np.median(np.abs(np.array(frequencies_hz) - middle))) <= ALIKE * middle else np.nan
