"""Whether what a model leaves swings at one frequency, the same in most trials: something that goes by itself.

What is missing and follows the motion has the motion's frequencies, which differ from one waveform to the next; a
supply that hunts, or something that turns, keeps its own. In each trial the power at a frequency, over that of the
noise around it, is exponentially distributed if it is noise (Schuster 1898). The noise itself is not white: time stamps
that jitter move the position, and its second derivative is the steeper the higher the frequency. The lower median of
the trials' powers tells, by the binomial distribution: a few trials that hold a line do not make it so. Trials of one
motion, with whatever load, hold what the model misses of that motion in common; they tell once, by their mean.

What drives the motor may swing, too: a supply that ripples, unseen, changes the effort by so much of the voltage, and
that voltage follows the motion. Its line is found in the residual times the voltage alone, as a modulated carrier's is.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, log

import numpy as np
from scipy.stats import binom

from compensator.lab.left_over.error_budget import PLAIN
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset, Trial

CHANCE = PLAIN.swing  # of such a line in noise alone, with any carrier
LEAST_HZ = 0.25  # what is slower turns less than once in a trial of some seconds
BAND = 0.9  # of the cut-off
AROUND_HZ = 1.0  # to both sides: noise is smooth over so much, and a line is narrower
BESIDE = (1.5, 3.5)  # widths of a line, to each side: what is as large there is no line, but noise that is slow
WIDTH = 4  # of a line, in frequencies: none falls between two of them
FEWEST_ROWS = 20
FEWEST_TRIALS = 4
ALIKE = 0.9  # correlation of two trials' velocities: of one motion
MOMENTS = 200  # of a trial, at which that is looked at


@dataclass(frozen=True, slots=True)
class Swing:
    """A line that most trials share.

    Attributes:
        frequency_hz: of it.
        chance: of such a line at any frequency, in noise alone.
        of_voltage: it swings with the voltage that drives the motor, as a supply does.
    """

    frequency_hz: float
    chance: float
    of_voltage: bool


def swing_of(dataset: Dataset, residual: FloatArray, rows: BoolArray) -> Swing | None:
    """The line that most trials share most surely, if any does for sure.

    Args:
        dataset: of the rows.
        residual: of the chosen rows, shape (rows.sum(),).
        rows: chosen, shape (N,).
    """
    voltage = dataset.rows_of([voltage_of(trial) for trial in dataset.trials])[rows]
    carriers = [(False, np.ones(len(residual)))]
    if np.any(voltage):
        carriers.append((True, voltage))
    found = [_line(dataset, residual * carrier, rows, of_voltage) for of_voltage, carrier in carriers]
    there = [one for one in found if one is not None and len(carriers) * one.chance <= CHANCE]
    return min(there, key=lambda one: one.chance, default=None)


@dataclass(frozen=True)
class Frequencies:
    """That a line is looked for at.

    Attributes:
        at_hz: some per width of a line, shape (m,); independent: how many of them are.
    """

    at_hz: FloatArray
    independent: float

    @classmethod
    def of(cls, times_s: list[FloatArray], cutoff_hz: float) -> "Frequencies":
        """Of trials' rows, each (n,)."""
        longest_s = max(float(time_s[-1] - time_s[0]) for time_s in times_s)
        highest_hz = BAND * min(cutoff_hz, *(0.5 / float(np.median(np.diff(time_s))) for time_s in times_s))
        at_hz = np.arange(LEAST_HZ, highest_hz, 1.0 / (WIDTH * longest_s))
        return cls(at_hz, max((highest_hz - LEAST_HZ) * longest_s, 1.0))


def voltage_of(trial: Trial) -> FloatArray:
    """Duty times supply over the trial, up to a constant; zero where no duty is known."""
    signals = trial.signals
    channels = signals.recording.channels
    if "duty" not in channels:
        return np.zeros(len(signals.time_s))
    duty = np.interp(signals.time_s, channels["time_s"], np.nan_to_num(channels["duty"]))
    supply = np.where(np.isfinite(signals.supply_v), signals.supply_v, 1.0)
    voltage: FloatArray = duty * supply
    return voltage


def _line(dataset: Dataset, values: FloatArray, rows: BoolArray, of_voltage: bool) -> Swing | None:
    """The frequency that stands out in most motions; None where there are too few trials."""
    index = dataset.trial_index[rows]
    parts = [
        (number, dataset.time_of(trial)[rows[dataset.trial_index == number]], values[index == number])
        for number, trial in enumerate(dataset.trials)
        if int((index == number).sum()) >= FEWEST_ROWS
    ]
    parts = [(number, time_s, own) for number, time_s, own in parts if np.any(own)]
    if len(parts) < FEWEST_TRIALS:
        return None
    frequencies = Frequencies.of([time_s for _, time_s, _ in parts], dataset.cutoff_hz)
    at_hz = frequencies.at_hz
    if len(at_hz) <= 2 * WIDTH:
        return None
    over = _over_noise(at_hz, [(time_s, own) for _, time_s, own in parts])
    motions = motions_of([dataset.trials[number] for number, _, _ in parts])
    told = np.array([over[motions == one].mean(axis=0) for one in np.unique(motions)])
    lower = np.sort(told, axis=0)[(len(told) - 1) // 2]
    best = int(np.argmax(np.where(is_peak(lower), lower, 0.0)))
    count = len(told) - (len(told) - 1) // 2  # motions that hold so much, or more
    chance = float(binom.sf(count - 1, len(told), exp(-float(lower[best]))))
    return Swing(float(at_hz[best]), min(1.0, frequencies.independent * chance), of_voltage)


def motions_of(trials: Sequence[Trial]) -> IntArray:
    """Which of the motions each trial has, counted through, shape (trials,)."""
    found: list[FloatArray] = []
    numbers = []
    for trial in trials:
        time_s, velocity = trial.motion.time_s, trial.motion.velocity
        own = np.interp(np.linspace(time_s[0], time_s[-1], MOMENTS), time_s, velocity)
        own = own / (float(np.linalg.norm(own)) or 1.0)
        same = [number for number, other in enumerate(found) if float(own @ other) >= ALIKE]
        numbers.append(same[0] if same else len(found))
        if not same:
            found.append(own)
    return np.array(numbers, dtype=np.int64)


def is_peak(values: FloatArray) -> BoolArray:
    """Which of the values (n,) are as large as all within the width of a line, to both sides.

    At the ends, where one side is not known, none is: power that only rises towards the slow end is noise.
    """
    peaks = np.zeros(len(values), dtype=bool)
    inner = slice(WIDTH, len(values) - WIDTH)
    peaks[inner] = values[inner] >= np.lib.stride_tricks.sliding_window_view(values, 2 * WIDTH + 1).max(axis=1)
    return peaks


def _over_noise(at_hz: FloatArray, parts: list[tuple[FloatArray, FloatArray]]) -> FloatArray:
    """Power of each trial at each frequency over that of the noise, shape (trials, m).

    Noise is the median around it, of all trials, or that of either side close by, where there is more. It may be the
    denser the slower it is, so that frequencies below those that are asked count on the lower side.
    """
    step_hz = float(at_hz[1] - at_hz[0])
    below = np.arange(at_hz[0] - step_hz, 0.0, -step_hz)[::-1]
    every = np.concatenate([below, at_hz])
    turns = 2j * np.pi
    powers = np.array([np.abs(np.exp(-turns * np.outer(every, time_s)) @ own) ** 2 for time_s, own in parts])
    asked = powers[:, len(below) :]
    powers = powers / asked.mean(axis=1, keepdims=True)
    floor = np.array([_noise_at(centre, every, powers, WIDTH * step_hz) for centre in at_hz])
    over: FloatArray = log(2.0) * powers[:, len(below) :] / np.maximum(floor, np.finfo(float).tiny)
    return over  # the median of Exp(1) is ln 2


def _noise_at(centre_hz: float, every_hz: FloatArray, powers: FloatArray, width_hz: float) -> float:
    """The median power (trials, m) of noise at a frequency where a line, if there is one, is so wide."""
    apart = every_hz - centre_hz
    chosen = [(np.abs(apart) <= AROUND_HZ) & (every_hz >= LEAST_HZ)]
    chosen += [(way * apart >= BESIDE[0] * width_hz) & (way * apart <= BESIDE[1] * width_hz) for way in (-1, 1)]
    return max(float(np.median(powers[:, some])) for some in chosen if some.any())


def swinging_in_words(swing: Swing) -> str:
    """What most trials share, and where to look."""
    where = "with the voltage: look at the supply" if swing.of_voltage else "in most trials: look at what turns"
    return f"swings at about {swing.frequency_hz:.2g} Hz {where}"
