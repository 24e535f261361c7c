"""The cut-off of the final filter: four times the bandwidth of the motion, but never where there is mostly noise.

Effort and the plainest columns (acceleration, velocity, its sign, position, sin q, and those that grow with the load)
are split into bands; in each the share of the effort that the columns explain is a multiple coherence. What the
columns lack lowers it in every band; noise, of the encoder after differentiation or of the effort itself, grows with
the frequency. Beyond the band where it falls below half of what it was further down there is mostly noise.
"""

from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.signal import butter, sosfiltfilt, welch

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.low_pass import low_pass
from compensator.lab.recordings.place_locked import place_locked_hz
from compensator.lab.recordings.processing import Signals, lowest_cutoff_hz, make_signals, sample_rate_hz
from compensator.lab.recordings.recording import FloatArray, Recording

COHERENT = 0.5  # of the highest coherence further down
LEAST_COHERENCE = 0.1  # less is no motion's
LOWEST_HZ = 2.0
MOTION_SHARE = 0.99
SEGMENT_S = 4.0
HARMONICS = 4.0
BANDS_PER_OCTAVE = 2
PASSED = 1.5  # times the frequency of a ripple: the filter lets most of it through
MOST_RECORDINGS = 24  # enough to see a corner; keeps the cost bounded


def choose_cutoff_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> float:
    """The final low-pass cut-off [Hz].

    Four times the motion's bandwidth, where the harmonics of a friction that changes sign still are, at most the noise
    corner; higher where the effort repeats with the place of the joint; so high that half of the longest recording is
    left between the edges of the filter; within 2 Hz and a fifth of the sample rate.

    Raises:
        UnusableDataError: a recording with fewer than four samples a second, or one that `make_signals` refuses.
    """
    slowest_hz, slowest = min((sample_rate_hz(r), r.name) for r in recordings)
    if slowest_hz < 2.0 * LOWEST_HZ:
        raise UnusableDataError(
            f"recording '{slowest}' has {slowest_hz:.3g} samples a second; at least {2.0 * LOWEST_HZ:g} are needed "
            "to see motion: check that time_s is in seconds, or record faster"
        )
    some = recordings[:: -(-len(recordings) // MOST_RECORDINGS)]
    highest_hz = 0.2 * slowest_hz
    some = _long_enough(some, highest_hz) or some  # all, if none is, for the error to be raised
    wanted_hz = min(HARMONICS * motion_bandwidth_hz(some, effort, facts, highest_hz), highest_hz)
    by_motion_hz = noise_corner_hz(some, effort, facts, wanted_hz)
    by_place_hz = min(PASSED * place_locked_hz(some, effort, facts), highest_hz)
    by_length_hz = min(2.0 * min(map(lowest_cutoff_hz, recordings)), highest_hz)
    return max(by_motion_hz, by_place_hz, by_length_hz, LOWEST_HZ)


def motion_bandwidth_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts, highest_hz: float) -> float:
    """The frequency below which lies 99 % of the velocity's power, over all recordings [Hz]."""
    frequencies = np.linspace(0.0, 3.0 * highest_hz, 1024)
    power = np.zeros(len(frequencies))
    for recording in recordings:
        signals = make_signals(recording, effort, facts, highest_hz)
        segment = min(len(signals.velocity), int(SEGMENT_S * signals.rate_hz))
        at, density = welch(signals.velocity, signals.rate_hz, nperseg=segment)
        power += np.interp(frequencies, at, density, right=0.0)
    share = np.cumsum(power) / max(float(power.sum()), np.finfo(float).tiny)
    return float(frequencies[min(int(np.searchsorted(share, MOTION_SHARE)), len(frequencies) - 1)])


def noise_corner_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts, highest_hz: float) -> float:
    """The frequency above which the motion explains less than half as much of the effort's power as below it [Hz]."""
    most, known_to_hz = 0.0, LOWEST_HZ
    edges = LOWEST_HZ * 2.0 ** (np.arange(64) / BANDS_PER_OCTAVE)
    # the last band takes in what is left: a sliver would hold too few values
    edges = np.append(edges[edges < 2.0 ** (-0.5 / BANDS_PER_OCTAVE) * highest_hz], max(highest_hz, LOWEST_HZ))
    for low, high in pairwise(edges.tolist()):
        signals = [make_signals(one, effort, facts, high) for one in _long_enough(recordings, high)]
        if not signals:
            continue
        share = _explained_share(signals, low, high)
        if share < max(COHERENT * most, LEAST_COHERENCE):
            return known_to_hz
        most, known_to_hz = max(most, share), high
    return known_to_hz


def _long_enough(recordings: Sequence[Recording], cutoff_hz: float) -> Sequence[Recording]:
    """Those that can be filtered so low.

    A quick start from rest is over in two seconds: beside longer motion it has no say in what is noise.
    """
    return [recording for recording in recordings if lowest_cutoff_hz(recording) <= cutoff_hz]


def _explained_share(trials: Sequence[Signals], low_hz: float, high_hz: float) -> float:
    """Multiple coherence in a band, less what so many columns explain by chance (Bendat, Piersol 2010).

    Chance is not taken off where a band holds hardly more independent values than there are columns.
    """
    stacks = [_band(trial, low_hz, high_hz) for trial in trials]
    columns = np.concatenate([stack[:-1] for stack in stacks], axis=1).T
    effort = np.concatenate([stack[-1] for stack in stacks])
    count, power = columns.shape[1], float(effort @ effort)
    if len(effort) <= count or power <= 0.0:
        return 0.0
    scale = np.linalg.norm(columns, axis=0)
    columns = columns / np.where(scale > 0, scale, 1.0)
    rest = effort - columns @ np.linalg.lstsq(columns, effort, rcond=1e-9)[0]
    length_s = sum(stack.shape[1] / trial.rate_hz for stack, trial in zip(stacks, trials, strict=True))
    free = 2.0 * (high_hz - low_hz) * length_s
    by_chance = free / (free - count) if free > 2.0 * count else 1.0
    return 1.0 - by_chance * float(rest @ rest) / power


def _band(trial: Signals, low_hz: float, high_hz: float) -> FloatArray:
    position = low_pass(trial.position, high_hz, trial.rate_hz)
    speed = max(1e-12, 0.02 * float(np.quantile(np.abs(trial.velocity), 0.95)))
    load = trial.recording.conditions.get("load_kg", 0.0)
    load_kg = float(load) if isinstance(load, int | float) else 0.0
    direction, sine = np.tanh(trial.velocity / speed), np.sin(position)
    plain = [trial.acceleration, trial.velocity, direction, position, sine]
    with_load = [load_kg * column for column in (trial.acceleration, direction, sine)]
    stack = np.array([*plain, *with_load, trial.effort])
    top = min(high_hz, 0.45 * trial.rate_hz)
    sections = _band_pass(low_hz, top, trial.rate_hz)
    filtered: FloatArray = sosfiltfilt(sections, np.nan_to_num(stack), axis=-1)
    moving = np.abs(trial.velocity) > speed
    return filtered[:, trial.usable & moving]


@lru_cache(maxsize=256)  # trials of one bench have one rate, and the design takes longer than the filtering
def _band_pass(low_hz: float, high_hz: float, rate_hz: float) -> FloatArray:
    sections: FloatArray = butter(2, (low_hz, high_hz), btype="bandpass", fs=rate_hz, output="sos")
    return sections
