"""The cut-off of the final filter: four times the bandwidth of the motion, but never where there is mostly noise.

Effort and the plainest columns (acceleration, velocity, its sign, position, sin q, and those that grow with the load)
are split into bands; in each the share of the effort that the columns explain is a multiple coherence. What the
columns lack lowers it in every band; noise grows with the frequency beside the effort. Beyond the band where it falls
below half of what it was further down there is mostly noise. What noise of the position does, no coherence tells
(`position_noise`).
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.signal import welch

from compensator.lab.errors import UnusableDataError
from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.place_locked import place_locked_hz
from compensator.lab.recordings.plain_columns import (
    ACCELERATION,
    ACCELERATION_OF_LOAD,
    explained_share,
    least_squares,
    load_kg,
    long_enough,
    stacked,
)
from compensator.lab.recordings.position_noise import SEGMENT_S
from compensator.lab.recordings.processing import EvenSamples, Signals, even_samples, lowest_cutoff_hz, sample_rate_hz
from compensator.lab.recordings.recording import Recording

COHERENT = 0.5  # of the highest coherence further down
LEAST_COHERENCE = 0.1  # less is no motion's
LOWEST_HZ = 2.0
HIGHEST_SHARE = 0.2  # of the sample rate: three times that, for the position, is beyond Nyquist already
MOTION_SHARE = 0.99
SURELY = 3.0  # times the noise: a spectral estimate from so few segments scatters so far once in a hundred (Welch 1967)
HARMONICS = 4.0
MOST_NOISE = 0.01  # of the effort, as a good current sensor; the corner grows with its power of 0.4
STEADY_HZ = 0.1  # what is slower has no acceleration
BANDS_PER_OCTAVE = 2
PASSED = 1.5  # times the frequency of a ripple: the filter lets most of it through
MOST_RECORDINGS = 24  # enough to see a corner; keeps the cost bounded


def choose_cutoff_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> float:
    """The final low-pass cut-off [Hz].

    Four times the motion's bandwidth, where the harmonics of a friction that changes sign still are, at most the corner
    of either noise; higher where the effort repeats with the place of the joint; so high that half of the longest
    recording is left between the edges of the filter; within 2 Hz and a fifth of the sample rate.

    Raises:
        UnusableDataError: a recording with fewer than four samples a second, too short, or refused by `even_samples`.
    """
    slowest_hz, slowest = min((sample_rate_hz(r), r.name) for r in recordings)
    if slowest_hz < 2.0 * LOWEST_HZ:
        raise UnusableDataError(
            f"recording '{slowest}' has {slowest_hz:.3g} samples a second; at least {2.0 * LOWEST_HZ:g} are needed "
            "to see motion: check that time_s is in seconds, or record faster"
        )
    some = recordings[:: -(-len(recordings) // MOST_RECORDINGS)]
    highest_hz = HIGHEST_SHARE * slowest_hz
    some = long_enough(some, highest_hz) or some  # all, if none is, for the error to be raised
    even = [even_samples(one, effort, facts) for one in some]
    motion_hz = motion_bandwidth_hz(even, highest_hz)
    by_position_hz = position_noise_corner_hz(even, max(motion_hz, LOWEST_HZ))
    by_motion_hz = noise_corner_hz(even, min(HARMONICS * motion_hz, by_position_hz, highest_hz))
    by_place_hz = min(PASSED * place_locked_hz(some, effort, facts), highest_hz)
    by_length_hz = min(2.0 * min(map(lowest_cutoff_hz, recordings)), highest_hz)
    return max(by_motion_hz, by_place_hz, by_length_hz, LOWEST_HZ)


def check_cutoff(cutoff_hz: float, recordings: Sequence[Recording]) -> None:
    """Raise where somebody's cut-off is higher than the data could choose: noise would go through unfiltered.

    Raises:
        UnusableDataError: so, or a recording with fewer than two samples.
    """
    rate_hz, slowest = min((sample_rate_hz(one), one.name) for one in recordings)
    highest_hz = max(HIGHEST_SHARE * rate_hz, LOWEST_HZ)
    told = f"{highest_hz:.3g}"
    if cutoff_hz > max(highest_hz, float(told)):
        raise UnusableDataError(
            f"cutoff_hz is {cutoff_hz:g} Hz; at most {told} Hz is wanted for the {rate_hz:.3g} samples a second of "
            f"recording '{slowest}': lower it, or leave it out to let the data choose"
        )


def motion_bandwidth_hz(recordings: Sequence[EvenSamples], highest_hz: float) -> float:
    """The frequency below which lies 99 % of the velocity's power, noise taken off, over all recordings [Hz]."""
    frequencies = np.linspace(0.0, 3.0 * highest_hz, 1024)
    power = np.zeros(len(frequencies))
    for recording in recordings:
        signals = recording.filtered(highest_hz)
        segment = min(len(signals.velocity), int(SEGMENT_S * signals.rate_hz))
        at, density = welch(signals.velocity, signals.rate_hz, nperseg=segment)
        noise = signals.position_noise * (2.0 * np.pi * at) ** 2
        power += np.interp(frequencies, at, np.where(density > SURELY * noise, density - noise, 0.0), right=0.0)
    share = np.cumsum(power) / max(float(power.sum()), np.finfo(float).tiny)
    return float(frequencies[min(int(np.searchsorted(share, MOTION_SHARE)), len(frequencies) - 1)])


def position_noise_corner_hz(recordings: Sequence[EvenSamples], motion_hz: float) -> float:
    """Up to where noise of the position, as inertia makes it effort, comes to MOST_NOISE of the effort [Hz].

    Args:
        recordings: of the joint.
        motion_hz: bandwidth of the motion, which tells the inertia; the corner is not below.

    Returns:
        The corner; infinite where the position has no noise, or no inertia is seen.
    """
    signals = _filtered(recordings, motion_hz)
    if not signals:
        return np.inf
    columns, measured, _ = stacked(signals, STEADY_HZ, motion_hz)
    if len(measured) <= columns.shape[1]:
        return np.inf
    found = least_squares(columns, measured)
    inertias = [found[ACCELERATION] + load_kg(one) * found[ACCELERATION_OF_LOAD] for one in signals]
    noises = [one.position_noise for one in signals]
    density = float(np.mean(np.square(inertias) * noises)) * (2.0 * np.pi) ** 4  # per Hz^5
    if not density > 0.0:
        return np.inf
    corner_hz = (5.0 * MOST_NOISE**2 * float(np.mean(measured**2)) / density) ** 0.2
    return max(float(corner_hz), motion_hz)


def noise_corner_hz(recordings: Sequence[EvenSamples], highest_hz: float) -> float:
    """The frequency above which the motion explains less than half as much of the effort's power as below it [Hz]."""
    most, known_to_hz = 0.0, LOWEST_HZ
    edges = LOWEST_HZ * 2.0 ** (np.arange(64) / BANDS_PER_OCTAVE)
    # the last band takes in what is left: a sliver would hold too few values
    edges = np.append(edges[edges < 2.0 ** (-0.5 / BANDS_PER_OCTAVE) * highest_hz], max(highest_hz, LOWEST_HZ))
    for low, high in pairwise(edges.tolist()):
        signals = _filtered(recordings, high)
        if not signals:
            continue
        share = explained_share(signals, low, high)
        if share < max(COHERENT * most, LEAST_COHERENCE):
            return known_to_hz
        most, known_to_hz = max(most, share), high
    return known_to_hz


def _filtered(recordings: Sequence[EvenSamples], cutoff_hz: float) -> list[Signals]:
    """Those that are long enough."""
    return [one.filtered(cutoff_hz) for one in recordings if lowest_cutoff_hz(one.recording) <= cutoff_hz]
