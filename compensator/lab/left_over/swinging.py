"""Whether what a model leaves swings at one frequency, the same in all motions: something that goes by itself.

What is missing and follows the motion has the motion's frequencies, which differ from one waveform to the next; what
turns by itself, or a supply that ripples, keeps its own. A matched filter tells: cosine and sine of every frequency,
times the *carrier*, without what the model explains of them, by least squares in each trial, as the phase is another
one in each. The carrier is one for what acts on the joint, and the voltage that drives the motor for what a supply
does: near reversals, too, where some joints have five rows of six.

What the model misses of a motion comes back with it, whatever the load. So trials of one motion tell once, by their
mean, and no motion more than up to a bound. Trials and motions count by how much a line would give them, the carrier's
power over the noise: for a small one, no other sum tells as much (the locally best test), and what is gained where
there is hardly any voltage is not the supply's.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.left_over.lines import MOST_GAIN, TINY, WIDTH, chance_over_noise, is_peak, over_noise
from compensator.lab.model.order_search import AT_ONCE, even_waves, explained
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.rows.dataset import FEWEST_ROWS, Trial
from compensator.lab.screening.base import Base
from compensator.lab.screening.candidates import WITH_CHAIN, Candidates

FEWEST_TURNS = 2.0  # in a usual trial: of fewer, a drift would seem to be a part
BAND = 0.9  # of the cut-off
REACH_HZ = (0.3, 1.0)  # of a line in a trial of some seconds, and of noise that is smooth
FEWEST_TRIALS = 4
ALIKE = 0.9  # correlation of the spectra of two trials' velocities: of one motion
MOMENTS = 200  # of the longest trial, at which that is looked at
LEAST_SHARE = 1e-3  # of what counts most: what counts less is left out

Indices = np.ndarray[tuple[int], np.dtype[np.intp]]


@dataclass(frozen=True, slots=True)
class Swing:
    """A line that all motions share.

    Attributes:
        frequency_hz: of it.
        of_voltage: it swings with the voltage that drives the motor, as a supply does.
    """

    frequency_hz: float
    of_voltage: bool


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


def swing_of(gathered: Candidates) -> Swing | None:
    """What acts on the joint at one frequency; None where nothing does for sure."""
    return _line(gathered, gathered.weights, of_voltage=False, most=PLAIN.swing)


def ripple_of(gathered: Candidates) -> Swing | None:
    """What goes with the voltage at one frequency; None where nothing does for sure, or where no duty is known.

    Args:
        gathered: the model, on all rows in motion.
    """
    dataset = gathered.fit.dataset
    voltage = dataset.rows_of([_voltage_of(trial) for trial in dataset.trials])[gathered.rows]
    return _line(gathered, gathered.weights * voltage, of_voltage=True, most=PLAIN.ripple)


def _line(gathered: Candidates, carrier: FloatArray, of_voltage: bool, most: float) -> Swing | None:
    """The line of a weighted carrier (n,) that stands out most; None where its chance in noise alone is more."""
    dataset, rows = gathered.fit.dataset, gathered.rows
    time_s = np.concatenate([dataset.time_of(trial) for trial in dataset.trials])[rows]
    index = np.where(carrier != 0.0, dataset.trial_index[rows], -1)
    numbers = [one for one in range(len(dataset.trials)) if (index == one).sum() >= FEWEST_ROWS]
    if len(numbers) < FEWEST_TRIALS:
        return None
    trials = [np.flatnonzero(index == one) for one in numbers]
    times_s = [time_s[own] for own in trials]
    longest_s = max(float(own[-1] - own[0]) for own in times_s)
    highest_hz = BAND * min(dataset.cutoff_hz, *(0.5 / float(np.median(np.diff(own))) for own in times_s))
    lowest_hz = FEWEST_TURNS / float(np.median([own[-1] - own[0] for own in times_s]))
    at_hz = np.arange(lowest_hz, highest_hz, 1.0 / (WIDTH * longest_s))
    if len(at_hz) <= 2 * WIDTH:
        return None
    motions = motions_of([dataset.trials[one] for one in numbers])
    told = _told(gathered, carrier, time_s, at_hz, trials, motions)
    peaks = is_peak(told.whole)
    if not peaks.any():
        return None
    best = int(np.argmax(np.where(peaks, told.whole, 0.0)))
    independent = max((highest_hz - lowest_hz) * longest_s, 1.0)
    chance = independent * chance_over_noise(told.gains[:, best], told.shares, float(told.known_from[best]))
    return Swing(float(at_hz[best]), of_voltage) if chance <= most else None


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
    over, around = over_noise(every, gains, counts, REACH_HZ)
    lasted_s = independent_s(counts, np.array([float(np.ptp(time_s[own])) for own in trials]))
    return _Told((within @ over)[:, len(below) :], shares, around[len(below) :] * (step_hz * lasted_s))


def _by_motion(information: FloatArray, motions: IntArray) -> tuple[FloatArray, FloatArray]:
    """How much each trial counts within its motion (k, trials), and the shares by which motions count (k,).

    Args:
        information: how much a line would give each trial, shape (trials,).
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


def _gains(base: Base, carrier: FloatArray, time_s: FloatArray, at_hz: FloatArray, trials: list[Indices]) -> FloatArray:
    """What each trial gains by each of even frequencies (m,), shape (trials, m)."""
    step_hz = float(at_hz[1] - at_hz[0]) if len(at_hz) > 1 else 0.0
    turning = 2.0 * np.pi * time_s
    columns = even_waves(turning, np.zeros(len(time_s)), carrier, float(at_hz[0]), step_hz, len(at_hz))
    return np.array([explained(columns[own], base.basis[own], base.residual[own]) for own in trials])


def _voltage_of(trial: Trial) -> FloatArray:
    """Duty times supply over the trial, up to a constant; zero where no duty is known."""
    signals = trial.signals
    channels = signals.recording.channels
    if "duty" not in channels:
        return np.zeros(len(signals.time_s))
    duty = np.interp(signals.time_s, channels["time_s"], np.nan_to_num(channels["duty"]))
    supply = np.where(np.isfinite(signals.supply_v), signals.supply_v, 1.0)
    voltage: FloatArray = duty * supply
    return voltage


def motions_of(trials: Sequence[Trial]) -> IntArray:
    """Which of the motions each trial has, counted through, shape (trials,).

    By the sizes of the velocity's frequencies: what is missing of a motion has these, whenever it began.
    """
    longest_s = max(float(np.ptp(trial.motion.time_s)) for trial in trials)
    found: list[FloatArray] = []
    numbers = []
    for trial in trials:
        time_s = trial.motion.time_s - trial.motion.time_s[0]
        velocity = np.interp(np.linspace(0.0, longest_s, MOMENTS), time_s, trial.motion.velocity, right=0.0)
        own = np.abs(np.fft.rfft(velocity, 2 * MOMENTS))
        own = own / (float(np.linalg.norm(own)) or 1.0)
        same = [number for number, other in enumerate(found) if float(own @ other) >= ALIKE]
        numbers.append(same[0] if same else len(found))
        if not same:
            found.append(own)
    return np.array(numbers, dtype=np.int64)


def swinging_in_words(swing: Swing) -> str:
    """What all motions share, and where to look."""
    where = "with the voltage: look at the supply" if swing.of_voltage else "in most trials: look at what turns"
    return f"swings at about {swing.frequency_hz:.2g} Hz {where}"
