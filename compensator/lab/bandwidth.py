"""Up to which frequency the motion tells anything about the effort: it sets the cut-off of the final filter.

Effort and the plainest columns (acceleration, velocity, its sign, position, sin q) are split into bands; in each the
share of the effort that the columns explain is a multiple coherence. Beyond the band where it falls below one half
there is mostly noise, of the encoder after differentiation or of the effort itself.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from scipy.signal import butter, sosfiltfilt

from compensator.lab.effort import Effort
from compensator.lab.facts import Facts
from compensator.lab.processing import Signals, low_pass, make_signals
from compensator.lab.recording import FloatArray, Recording

COHERENT = 0.5
LOWEST_HZ = 2.0
BANDS_PER_OCTAVE = 2
MOST_RECORDINGS = 24  # enough to see a corner; keeps the cost bounded


def choose_cutoff_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts) -> float:
    """The final low-pass cut-off [Hz]: the noise corner, within 2 Hz and a fifth of the sample rate."""
    slowest_hz = min(1.0 / float(np.median(np.diff(r.channels["time_s"]))) for r in recordings)
    some = recordings[:: -(-len(recordings) // MOST_RECORDINGS)]
    corner = noise_corner_hz(some, effort, facts, 0.4 * slowest_hz)
    return float(np.clip(corner, LOWEST_HZ, 0.2 * slowest_hz))


def noise_corner_hz(recordings: Sequence[Recording], effort: Effort, facts: Facts, highest_hz: float) -> float:
    """The frequency above which the motion explains less than half of the effort's power [Hz]."""
    edges = LOWEST_HZ * 2.0 ** (np.arange(64) / BANDS_PER_OCTAVE)
    edges = np.append(edges[edges < highest_hz], highest_hz)
    for low, high in pairwise(edges):
        signals = [make_signals(recording, effort, facts, high) for recording in recordings]
        if _explained_share(signals, low, high) < COHERENT:
            return float(low)
    return float(highest_hz)


def _explained_share(trials: Sequence[Signals], low_hz: float, high_hz: float) -> float:
    stacks = [_band(trial, low_hz, high_hz) for trial in trials]
    columns = np.concatenate([stack[:-1] for stack in stacks], axis=1).T
    effort = np.concatenate([stack[-1] for stack in stacks])
    if len(effort) <= columns.shape[1]:
        return 0.0
    scale = np.linalg.norm(columns, axis=0)
    columns = columns / np.where(scale > 0, scale, 1.0)
    coefficients = np.linalg.lstsq(columns, effort, rcond=1e-9)[0]
    rest = effort - columns @ coefficients
    power = float(effort @ effort)
    return 1.0 - float(rest @ rest) / power if power > 0 else 0.0


def _band(trial: Signals, low_hz: float, high_hz: float) -> FloatArray:
    position = low_pass(trial.position, high_hz, trial.rate_hz)
    speed = max(1e-12, 0.02 * float(np.quantile(np.abs(trial.velocity), 0.95)))
    stack = np.array(
        [
            trial.acceleration,
            trial.velocity,
            np.tanh(trial.velocity / speed),
            position,
            np.sin(position),
            trial.effort,
        ]
    )
    top = min(high_hz, 0.45 * trial.rate_hz)
    sections = butter(2, (low_hz, top), btype="bandpass", fs=trial.rate_hz, output="sos")
    filtered: FloatArray = sosfiltfilt(sections, np.nan_to_num(stack), axis=-1)
    moving = np.abs(trial.velocity) > speed
    return filtered[:, trial.usable & moving]
