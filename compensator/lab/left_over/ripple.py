"""Whether the voltage that drives the motor ripples unseen: a matched filter for what a supply does to the effort.

Cosine and sine of every frequency, times the voltage, as a supply that ripples makes them, without what the model
explains of them, by least squares in each trial (Lomb 1976, Scargle 1982; the phase is another one in each). What a
trial gains by them is, over the noise's density there, an exponential variable if nothing ripples. The gains of all
trials are summed, each up to a bound, so that no few trials, whose motion has that frequency, make a line.

The density is what trials gain by the frequencies around, without the line's own. Noise that is learnt from all that
the model leaves would have the ripple in it, and hide it: what is periodic is no noise, but lies in a band of it.
"""

import numpy as np

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.swinging import (
    AROUND_HZ,
    FEWEST_ROWS,
    FEWEST_TRIALS,
    WIDTH,
    Frequencies,
    Swing,
    is_peak,
    voltage_of,
)
from compensator.lab.left_over.waves import Waves
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import IntArray
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates
from compensator.lab.screening.evidence import Base

CARRIERS = 2  # the other is none, of `swinging.py`
CHANCE = PLAIN.ripple  # of such a line in noise alone, with any carrier
MOST_OF_TRIAL = 5.0  # of what it gains over the noise: noise alone has so much once in 150
LINE_HZ = 0.3  # from its middle on, in a trial of some seconds: what is further away is not of it
AT_ONCE = 2**21  # values of columns
NEW = 0.05  # share of a column's power beside the model: of less, little can be told from the model itself
STEP = 0.05  # of a sum's distribution
NODES = 9  # of an integral over the noise
TINY = float(np.finfo(float).tiny)

Indices = np.ndarray[tuple[int], np.dtype[np.intp]]


def ripple_of(gathered: Candidates) -> Swing | None:
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
    if len(at_hz) <= 2 * WIDTH:
        return None
    base, carrier = gathered.as_measured(WITH_CHAIN), gathered.weights * voltage
    portions = -(-2 * len(at_hz) * len(carrier) // AT_ONCE)
    parts = [_gains(base, carrier, time_s, some, trials) for some in np.array_split(at_hz, portions)]
    gains, around = _over_noise(at_hz, np.concatenate(parts, axis=1))
    whole = np.minimum(gains, MOST_OF_TRIAL).sum(axis=0)
    lasted_s = [float(np.ptp(time_s[own])) for own in trials]
    peaks = is_peak(whole)
    if not peaks.any():
        return None
    best = int(np.argmax(np.where(peaks, whole, 0.0)))
    independent = float(around[best]) * float(at_hz[1] - at_hz[0]) * sum(lasted_s)
    chance = min(1.0, frequencies.independent * chance_over_noise(gains[:, best], independent))
    return Swing(float(at_hz[best]), chance, of_voltage=True) if CARRIERS * chance <= CHANCE else None


def _over_noise(at_hz: FloatArray, gains: FloatArray) -> tuple[FloatArray, IntArray]:
    """What trials gain (trials, m) over what they would by noise alone, and how many frequencies around tell that.

    That is the mean around each frequency, of all trials; a trial's own scale is its mean over all frequencies.
    """
    gains = gains / np.maximum(gains.mean(axis=1, keepdims=True), TINY)
    bounded = np.minimum(gains, MOST_OF_TRIAL).mean(axis=0) / (1.0 - float(np.exp(-MOST_OF_TRIAL)))
    apart_hz = np.abs(np.subtract.outer(at_hz, at_hz))
    around = (apart_hz <= AROUND_HZ) & (apart_hz > LINE_HZ)
    count = around.sum(axis=1)
    floor = (around @ bounded) / np.maximum(count, 1)
    return gains / np.maximum(floor, TINY), count


def chance_over_noise(gains: FloatArray, independent: float) -> float:
    """The chance of such a sum of gains (n,) over noise that is known from so many independent powers.

    The mean of so many exponential variables scatters by one over their root, which a sum of gains far in its tail
    takes for evidence: the chance is the mean over what the noise may be (as Snedecor's F is).
    """
    places, shares = np.polynomial.hermite_e.hermegauss(NODES)
    scales = np.exp(places / np.sqrt(max(independent, 1.0)))
    chances = [chance_of_sum(gains * scale) for scale in scales]
    return float(shares @ chances / shares.sum())


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


def _gains(base: Base, carrier: FloatArray, time_s: FloatArray, at_hz: FloatArray, trials: list[Indices]) -> FloatArray:
    """What each trial gains by each frequency (m,), shape (trials, m)."""
    phase = 2.0 * np.pi * np.outer(time_s, at_hz)
    columns = carrier[:, None] * np.concatenate([np.cos(phase), np.sin(phase)], axis=1)
    return np.array([_gained(columns[own], base.basis[own], base.residual[own]) for own in trials])


def _gained(columns: FloatArray, basis: FloatArray, residual: FloatArray) -> FloatArray:
    """By cosines and sines (n, 2m) of one trial, beside what the model explains; 0 where they are not apart from it."""
    waves = Waves.of(columns, basis, residual)
    return waves.where(waves.left.sum(axis=0) > NEW * waves.whole.sum(axis=0))
