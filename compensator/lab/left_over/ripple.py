"""Whether the voltage that drives the motor ripples unseen: a matched filter for what a supply does to the effort.

Cosine and sine of every frequency, times the voltage, as a supply that ripples makes them, without what the model
explains of them, by least squares in each trial (Lomb 1976, Scargle 1982; the phase is another one in each). What a
trial gains by them is, over the noise's density there, an exponential variable if nothing ripples.

A supply ripples wherever the motor is driven, near reversals too, where some joints have five rows of six. What the
model misses there comes back with the motion, whatever the load, and so with the motion's own frequencies. So trials of
one motion tell once, by their mean, as in `swinging.py`, and no motion more than up to a bound. Trials and motions
count by how much a ripple would give them, its voltage's power over the noise: for a small one, no other sum tells as
much (the locally best test), and what is gained where there is hardly any voltage is not the supply's.

The density is what trials gain by the frequencies around, without the line's own. Noise that is learnt from all that
the model leaves would have the ripple in it, and hide it: what is periodic is no noise, but lies in a band of it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import next_fast_len

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.swinging import (
    AROUND_HZ,
    FEWEST_ROWS,
    FEWEST_TRIALS,
    WIDTH,
    Frequencies,
    Swing,
    is_peak,
    motions_of,
    voltage_of,
)
from compensator.lab.left_over.waves import Waves
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.screening.base import Base
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates

CARRIERS = 2  # the other is none, of `swinging.py`
CHANCE = PLAIN.ripple  # of such a line in noise alone, with any carrier
MOST_GAIN = 5.0  # of a trial, or a motion, over the noise: noise alone has so much once in 150
LINE_HZ = 0.3  # from its middle on, in a trial of some seconds: what is further away is not of it
AT_ONCE = 2**21  # values of columns
NEW = 0.05  # share of a column's power beside the model: of less, little can be told from the model itself
STEP = 0.05  # of a sum's distribution, in gains of what counts most
LEAST_SHARE = 1e-3  # of what counts most: what counts less is left out
NODES = 9  # of an integral over the noise
TINY = float(np.finfo(float).tiny)

Indices = np.ndarray[tuple[int], np.dtype[np.intp]]


@dataclass(frozen=True)
class _Told:
    """What motions tell of each frequency.

    Attributes:
        gains: over the noise, shape (k, m).
        shares: by which motions count, shape (k,).
        known_from: how many independent powers tell the noise at each frequency, shape (m,).
    """

    gains: FloatArray
    shares: FloatArray
    known_from: FloatArray

    @property
    def whole(self) -> FloatArray:
        """What all motions gain together, shape (m,)."""
        found: FloatArray = self.shares @ np.minimum(self.gains, MOST_GAIN)
        return found


def ripple_of(gathered: Candidates) -> Swing | None:
    """The frequency at which what is left swings most surely with the voltage; None where it does not for sure.

    Args:
        gathered: the model, on all rows in motion.
    """
    dataset, rows = gathered.fit.dataset, gathered.rows
    voltage = dataset.rows_of([voltage_of(trial) for trial in dataset.trials])[rows]
    time_s = np.concatenate([dataset.time_of(trial) for trial in dataset.trials])[rows]
    index = np.where(voltage != 0.0, dataset.trial_index[rows], -1)
    numbers = [one for one in range(len(dataset.trials)) if (index == one).sum() >= FEWEST_ROWS]
    if len(numbers) < FEWEST_TRIALS:
        return None
    trials = [np.flatnonzero(index == one) for one in numbers]
    frequencies = Frequencies.of([time_s[own] for own in trials], dataset.cutoff_hz)
    if len(frequencies.at_hz) <= 2 * WIDTH:
        return None
    motions = motions_of([dataset.trials[one] for one in numbers])
    told = _told(gathered, gathered.weights * voltage, time_s, frequencies.at_hz, trials, motions)
    peaks = is_peak(told.whole)
    if not peaks.any():
        return None
    best = int(np.argmax(np.where(peaks, told.whole, 0.0)))
    by_chance = chance_over_noise(told.gains[:, best], told.shares, float(told.known_from[best]))
    chance = min(1.0, frequencies.independent * by_chance)
    return Swing(float(frequencies.at_hz[best]), chance, of_voltage=True) if CARRIERS * chance <= CHANCE else None


def _told(
    gathered: Candidates,
    carrier: FloatArray,
    time_s: FloatArray,
    at_hz: FloatArray,
    trials: list[Indices],
    motions: IntArray,
) -> _Told:
    """What trials (rows of each) tell of frequencies (m,), by their motions (trials,); carrier (n,) and time (n,).

    Noise may be the denser the slower it is, so that frequencies below those that are asked count as noise, too.
    """
    base = gathered.as_measured(WITH_CHAIN)
    step_hz = float(at_hz[1] - at_hz[0])
    below = np.arange(at_hz[0] - step_hz, 0.0, -step_hz)[::-1]
    every = np.concatenate([below, at_hz])
    portions = -(-2 * len(every) * len(carrier) // AT_ONCE)
    parts = [_gains(base, carrier, time_s, some, trials) for some in np.array_split(every, portions)]
    gains = np.concatenate(parts, axis=1)
    information = np.array([carrier[own] @ carrier[own] for own in trials]) / np.maximum(gains.mean(axis=1), TINY)
    within, shares = _by_motion(information, motions)
    counts = shares @ within
    over, around = _over_noise(every, gains, counts)
    lasted_s = independent_s(counts, np.array([float(np.ptp(time_s[own])) for own in trials]))
    return _Told((within @ over)[:, len(below) :], shares, around[len(below) :] * (step_hz * lasted_s))


def _by_motion(information: FloatArray, motions: IntArray) -> tuple[FloatArray, FloatArray]:
    """How much each trial counts within its motion (k, trials), and the shares by which motions count (k,).

    Args:
        information: how much a ripple would give each trial, shape (trials,).
        motions: of each trial, shape (trials,).
    """
    theirs = np.equal.outer(np.unique(motions), motions)
    means = (theirs @ information) / theirs.sum(axis=1)
    counts = means > LEAST_SHARE * means.max()
    within = theirs[counts] * information
    return within / within.sum(axis=1, keepdims=True), means[counts] / means.max()


def independent_s(counts: FloatArray, lasted_s: FloatArray) -> float:
    """How long one trial would last whose noise is known as well as that of trials (n,) as they count (n,)."""
    return float(counts.sum() ** 2 / np.sum(counts**2 / lasted_s))


def _over_noise(at_hz: FloatArray, gains: FloatArray, counts: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What trials gain (trials, m) over what they would by noise alone, and how many frequencies around tell that.

    That is the mean around each frequency, of all trials, as each counts (trials,) in what is summed: those that count
    for little may have noise of another colour. A trial's own scale is its mean over all frequencies.
    """
    gains = gains / np.maximum(gains.mean(axis=1, keepdims=True), TINY)
    bounded = counts @ np.minimum(gains, MOST_GAIN) / (counts.sum() * (1.0 - float(np.exp(-MOST_GAIN))))
    apart_hz = np.abs(np.subtract.outer(at_hz, at_hz))
    around = (apart_hz <= AROUND_HZ) & (apart_hz > LINE_HZ)
    count = around.sum(axis=1).astype(np.float64)
    floor = (around @ bounded) / np.maximum(count, 1)
    return gains / np.maximum(floor, TINY), count


def chance_over_noise(gains: FloatArray, shares: FloatArray, independent: float) -> float:
    """The chance of such a sum of gains (n,), by shares (n,), over noise that is known from so many independent powers.

    The mean of so many exponential variables scatters by one over their root, which a sum of gains far in its tail
    takes for evidence: the chance is the mean over what the noise may be (as Snedecor's F is).
    """
    places, chances_of = np.polynomial.hermite_e.hermegauss(NODES)
    scales = np.exp(places / np.sqrt(max(independent, 1.0)))
    chances = [chance_of_sum(gains * scale, shares) for scale in scales]
    return float(chances_of @ chances / chances_of.sum())


def chance_of_sum(gains: FloatArray, shares: FloatArray) -> float:
    """The chance that as many exponential variables, each up to MOST_GAIN, have as large a sum, by shares (n,)."""
    step = STEP * float(shares.max())
    most = [int(np.ceil(MOST_GAIN * share / step)) for share in shares]
    size = next_fast_len(sum(most) + 1, real=True)
    passed, counted = np.ones(size // 2 + 1, dtype=complex), 0.0
    for share, highest in zip(shares, most, strict=True):
        edges = np.exp(-np.minimum(step / share * np.arange(highest + 1), MOST_GAIN))
        chances = np.append(edges[:-1] - edges[1:], edges[-1])
        passed *= np.fft.rfft(chances, size)
        counted += step * float(chances @ np.arange(highest + 1))
    sums = np.fft.irfft(passed, size)
    # each is counted at the lower end of its step, and so for less than it is on average
    missed = float(shares.sum()) * (1.0 - np.exp(-MOST_GAIN)) - counted
    at = int((float(shares @ np.minimum(gains, MOST_GAIN)) - missed) / step)
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
