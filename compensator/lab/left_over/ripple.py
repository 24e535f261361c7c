"""Whether the voltage that drives the motor ripples unseen, on rows whitened by the noise that a model would leave.

A matched filter: cosine and sine of every frequency, times the voltage, as a supply that ripples makes them, whitened,
without what the model explains of them, by least squares in each trial (Lomb 1976, Scargle 1982; the phase is another
one in each). Twice what a trial gains by them is in noise alone chi-squared of two degrees of freedom. The gains of all
trials are summed, each up to a bound, so that no few trials, whose motion has that frequency, make a line.

Noise is known for all rows together, and there may be more of it at some frequencies than that: where trials gain more
by the frequencies around a line than noise would, the line counts for less by as much.
"""

import numpy as np

from compensator.lab.left_over.swinging import (
    AROUND_HZ,
    FEWEST_ROWS,
    FEWEST_TRIALS,
    Frequencies,
    Swing,
    is_peak,
    voltage_of,
)
from compensator.lab.left_over.waves import Waves
from compensator.lab.left_over.white_rows import WhiteRows
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.candidates import Candidates

CARRIERS = 2  # the other is none, of `swinging.py`
CHANCE = 2e-4  # of such a line in noise alone, with any carrier
MOST_OF_TRIAL = 5.0  # of half of what it gains: noise alone has so much once in 150
LINE_HZ = 0.2  # from its middle on: what is further away is not of it
AT_ONCE = 2**21  # values of columns
NEW = 0.05  # share of a column's power beside the model: of less, little can be told from the model itself
STEP = 0.05  # of a sum's distribution

Indices = np.ndarray[tuple[int], np.dtype[np.intp]]


def ripple_of(gathered: Candidates, white: WhiteRows) -> Swing | None:
    """The frequency at which what is left swings most surely with the voltage; None where it does not for sure."""
    dataset, rows = gathered.fit.dataset, gathered.rows
    voltage = dataset.rows_of([voltage_of(trial) for trial in dataset.trials])[rows]
    time_s = np.concatenate([dataset.time_of(trial) for trial in dataset.trials])[rows]
    index = dataset.trial_index[rows]
    trials = [np.flatnonzero((index == one) & (voltage != 0.0)) for one in np.unique(index)]
    trials = [own for own in trials if len(own) >= FEWEST_ROWS]
    if len(trials) < FEWEST_TRIALS:
        return None
    frequencies = Frequencies.of([time_s[own] for own in trials], dataset.cutoff_hz)
    at_hz = frequencies.at_hz
    if len(at_hz) < 3:
        return None
    carrier = white.weights * voltage
    portions = -(-2 * len(at_hz) * len(carrier) // AT_ONCE)
    parts = [_gains(white, carrier, time_s, some, trials) for some in np.array_split(at_hz, portions)]
    gains = np.concatenate(parts, axis=1)
    whole = np.minimum(gains, MOST_OF_TRIAL).sum(axis=0)
    best = 1 + int(np.argmax(np.where(is_peak(whole), whole[1:-1], 0.0)))
    noise = _noise_around(at_hz, gains, best)
    chance = frequencies.independent * chance_of_sum(gains[:, best] / noise)
    return Swing(float(at_hz[best]), chance, of_voltage=True) if CARRIERS * chance <= CHANCE else None


def _noise_around(at_hz: FloatArray, gains: FloatArray, best: int) -> float:
    """What trials gain (trials, m) around a frequency, over what noise would, if it is more."""
    apart_hz = np.abs(at_hz - at_hz[best])
    around = gains[:, (apart_hz <= AROUND_HZ) & (apart_hz > LINE_HZ)]
    if around.size == 0:
        return 1.0
    return max(float(np.minimum(around, MOST_OF_TRIAL).mean()) / (1.0 - float(np.exp(-MOST_OF_TRIAL))), 1.0)


def chance_of_sum(gains: FloatArray) -> float:
    """The chance that as many exponential variables, each up to MOST_OF_TRIAL, have a sum as large as these (n,)."""
    edges = np.exp(-np.arange(0.0, MOST_OF_TRIAL + STEP / 2, STEP))
    one = np.append(edges[:-1] - edges[1:], edges[-1])
    count = len(gains)
    size = count * len(one)
    sums = np.fft.irfft(np.fft.rfft(one, size) ** count, size)
    # each is counted at the lower end of its step
    at = int((float(np.minimum(gains, MOST_OF_TRIAL).sum()) / STEP) - 0.5 * count)
    return float(np.clip(sums[max(at, 0) :].sum(), 0.0, 1.0))


def _gains(
    white: WhiteRows, carrier: FloatArray, time_s: FloatArray, at_hz: FloatArray, trials: list[Indices]
) -> FloatArray:
    """Half of what each trial gains by each frequency (m,), shape (trials, m)."""
    phase = 2.0 * np.pi * np.outer(time_s, at_hz)
    columns = carrier[:, None] * np.concatenate([np.cos(phase), np.sin(phase)], axis=1)
    columns = white.whitening.whitened(columns)
    return np.array([_gained(columns[own], white.basis[own], white.residual[own]) for own in trials])


def _gained(columns: FloatArray, basis: FloatArray, residual: FloatArray) -> FloatArray:
    """By cosines and sines (n, 2m) of one trial, beside what the model explains; 0 where they are not apart from it."""
    waves = Waves.of(columns, basis, residual)
    return 0.5 * waves.where(waves.left.sum(axis=0) > NEW * waves.whole.sum(axis=0))
