"""Noise of the position, and where it would outgrow the effort that it is held against.

Noise of the position is noise of the columns: it makes coefficients too small (errors in variables: Fuller 1987). Twice
differentiated, and times the inertia, its density grows with the fourth power of the frequency. Counts make some; more
comes from samples that are now fresh and now a millisecond old, as behind a drive that updates its values at its own
rate: in motion each is off by the way of that time.
"""

from collections.abc import Sequence

import numpy as np
from scipy.signal import welch

from compensator.lab.recordings.facts import Effort, Facts
from compensator.lab.recordings.plain_columns import (
    ACCELERATION,
    ACCELERATION_OF_LOAD,
    least_squares,
    load_kg,
    long_enough,
    stacked,
)
from compensator.lab.recordings.processing import make_signals, sample_rate_hz
from compensator.lab.recordings.recording import FloatArray, Recording

MOST = 0.01  # of the effort, as a good current sensor; the corner grows with its power of 0.4
NOISE_ONLY = 0.75  # of half the sample rate: above, a position holds hardly any motion
SEGMENT_S = 4.0
STEADY_HZ = 0.1  # what is slower has no acceleration


def position_noise(recording: Recording, facts: Facts) -> float:
    """Density of the noise of a measured position, in its unit squared per Hz: that of its highest frequencies."""
    time_s, rate_hz = recording.channels["time_s"], sample_rate_hz(recording)
    measured = recording.channels[f"position_{facts.position_unit}"]
    finite = np.isfinite(measured)
    even = np.arange(len(time_s)) / rate_hz + time_s[0]
    position = np.interp(even, time_s[finite], measured[finite])
    at_hz, density = welch(position, rate_hz, nperseg=min(len(position), max(int(SEGMENT_S * rate_hz), 1)))
    above = at_hz > NOISE_ONLY * 0.5 * rate_hz
    passed = _passed(even, time_s[finite], at_hz[above] / rate_hz)
    return float(np.mean(density[above] / passed)) if above.any() else 0.0


def _passed(even: FloatArray, time_s: FloatArray, per_sample: FloatArray) -> FloatArray:
    """Share of white noise that is left between samples, where two that are weighted by 1 - w and w make a value.

    Args:
        even: times that values are wanted at.
        time_s: of the samples.
        per_sample: frequencies, in cycles per sample, shape (m,).
    """
    after = np.clip(np.searchsorted(time_s, even), 1, len(time_s) - 1)
    weight = np.clip((even - time_s[after - 1]) / (time_s[after] - time_s[after - 1]), 0.0, 1.0)
    mixed = float(np.mean(weight * (1.0 - weight)))
    passed: FloatArray = 1.0 - 2.0 * mixed * (1.0 - np.cos(2.0 * np.pi * per_sample))
    return passed


def position_noise_corner_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts, motion_hz: float) -> float:
    """Up to where noise of the position, as inertia makes it effort, comes to MOST of the effort [Hz].

    Args:
        recordings: of the joint.
        effort: which quantity.
        facts: of the joint.
        motion_hz: bandwidth of the motion, which tells the inertia; the corner is not below.

    Returns:
        The corner; infinite where the position has no noise, or no inertia is seen.
    """
    signals = [make_signals(one, effort, facts, motion_hz) for one in long_enough(recordings, motion_hz)]
    if not signals:
        return np.inf
    columns, measured, _ = stacked(signals, STEADY_HZ, motion_hz)
    if len(measured) <= columns.shape[1]:
        return np.inf
    found = least_squares(columns, measured)
    inertias = [found[ACCELERATION] + load_kg(one) * found[ACCELERATION_OF_LOAD] for one in signals]
    noises = [position_noise(one.recording, facts) for one in signals]
    density = float(np.mean(np.square(inertias) * noises)) * (2.0 * np.pi) ** 4  # per Hz^5
    if not density > 0.0:
        return np.inf
    corner_hz = (5.0 * MOST**2 * float(np.mean(measured**2)) / density) ** 0.2
    return max(float(corner_hz), motion_hz)
