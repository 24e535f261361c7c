"""Whether what a model leaves is more than noise, and has a shape, whatever the catalogue says of it.

Two questions that need no model of what is missing. Noise: the effort's own scatter above the band of the motion, taken
as white down into it, is what noise alone would leave. Shape: in a residual without any, no frequency holds more than
chance gives it (Fisher 1929). Only where both say no is there something left: measured noise may be coloured, and the
residual of a real joint is never quite white.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.dataset import Dataset, Trial
from compensator.lab.processing import low_pass
from compensator.lab.recording import FloatArray
from compensator.lab.regimes import BoolArray

FAR = 1.5  # times the noise: more than twice its power
CHANCE = 0.01  # of so strong a frequency in a trial whose residual has no shape
MOST = 0.5  # share of the trials
FEWEST_ROWS = 20
ALIKE = 0.1  # relative spread of the frequencies of one source
NORMAL = 1.4826  # standard deviation over median absolute deviation


@dataclass(frozen=True, slots=True)
class Remainder:
    """What a model leaves.

    Attributes:
        over_noise: its root mean square over that of the noise; NaN where there is none to be seen.
        shaped: share of the trials in which one frequency stands out.
        frequency_hz: of it, where it is the same in all of these; NaN where it is not.
    """

    over_noise: float
    shaped: float
    frequency_hz: float

    @property
    def is_more_than_noise(self) -> bool:
        """Whether something is left to be explained."""
        return self.over_noise > FAR and self.shaped > MOST


def remainder_of(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> Remainder:
    """Judge what a model leaves.

    Args:
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        rows: chosen, shape (N,).
    """
    noise = _noise(dataset, rows)
    over = float(np.sqrt(np.mean(residual**2))) / noise if noise > 0.0 else np.nan
    trials = dataset.trial_index[rows]
    found = [
        _strongest(dataset, trial, residual[trials == index])
        for index, trial in enumerate(dataset.trials)
        if int((trials == index).sum()) >= FEWEST_ROWS
    ]
    clear = [frequency for chance, frequency in found if chance <= CHANCE]
    return Remainder(over, len(clear) / len(found) if found else 0.0, _common(clear))


def _noise(dataset: Dataset, rows: BoolArray) -> float:
    """Root mean square that the effort's noise leaves after the final filter."""
    used = np.unique(dataset.trial_index[rows])
    powers = [_noise_power(dataset.trials[index], dataset.cutoff_hz) for index in used]
    return float(np.sqrt(np.mean(powers))) if powers else 0.0


def _noise_power(trial: Trial, cutoff_hz: float) -> float:
    """Of the effort above the band of the motion, as a density, times the band of the final filter."""
    signals = trial.signals
    nyquist_hz = 0.5 * signals.rate_hz
    above_hz = min(max(3.0 * cutoff_hz, 0.2 * nyquist_hz), 0.6 * nyquist_hz)
    if not signals.usable.any() or cutoff_hz >= above_hz:
        return 0.0
    fast = signals.effort - low_pass(signals.effort[None], above_hz, signals.rate_hz)[0]
    spread = NORMAL * float(np.median(np.abs(fast[signals.usable])))
    return spread**2 * cutoff_hz / (nyquist_hz - above_hz)


def _strongest(dataset: Dataset, trial: Trial, residual: FloatArray) -> tuple[float, float]:
    """The chance of a frequency as strong as the strongest, in a residual without shape, and that frequency [Hz]."""
    power = np.abs(np.fft.rfft(residual - residual.mean())[1:]) ** 2
    whole = float(power.sum())
    if whole == 0.0:
        return 1.0, np.nan
    best = int(np.argmax(power))
    share = float(power[best]) / whole
    chance = len(power) * (1.0 - share) ** (len(power) - 1)
    times_s = dataset.time_of(trial)
    period_s = float(np.median(np.diff(times_s))) if len(times_s) > 1 else np.nan
    return min(chance, 1.0), (best + 1) / (len(residual) * period_s)


def _common(frequencies_hz: list[float]) -> float:
    if len(frequencies_hz) < 3:
        return np.nan
    middle = float(np.median(frequencies_hz))
    return middle if float(np.median(np.abs(np.array(frequencies_hz) - middle))) <= ALIKE * middle else np.nan
