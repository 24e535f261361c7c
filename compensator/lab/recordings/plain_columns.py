"""The plainest columns in a band of frequencies: what any joint's effort holds, before there is a model."""

from collections.abc import Sequence

import numpy as np

from compensator.lab.recordings.low_pass import band_pass_thinned, low_pass
from compensator.lab.recordings.processing import Signals, lowest_cutoff_hz
from compensator.lab.recordings.recording import FloatArray, Recording

ACCELERATION, ACCELERATION_OF_LOAD = 0, 5  # places among the columns


def long_enough(recordings: Sequence[Recording], cutoff_hz: float) -> Sequence[Recording]:
    """Those that can be filtered so low.

    A quick start from rest is over in two seconds: beside longer motion it has no say in what is noise.
    """
    return [recording for recording in recordings if lowest_cutoff_hz(recording) <= cutoff_hz]


def explained_share(trials: Sequence[Signals], low_hz: float, high_hz: float) -> float:
    """Multiple coherence in a band, less what so many columns explain by chance (Bendat, Piersol 2010).

    Chance is not taken off where a band holds hardly more independent values than there are columns.
    """
    columns, effort, length_s = stacked(trials, low_hz, high_hz)
    count, power = columns.shape[1], float(effort @ effort)
    if len(effort) <= count or power <= 0.0:
        return 0.0
    rest = effort - columns @ least_squares(columns, effort)
    free = 2.0 * (high_hz - low_hz) * length_s
    by_chance = free / (free - count) if free > 2.0 * count else 1.0
    return 1.0 - by_chance * float(rest @ rest) / power


def least_squares(columns: FloatArray, effort: FloatArray) -> FloatArray:
    """Coefficients (k,) of columns (n, k) of any scale."""
    scale = np.linalg.norm(columns, axis=0)
    scale = np.where(scale > 0, scale, 1.0)
    found: FloatArray = np.linalg.lstsq(columns / scale, effort, rcond=1e-9)[0] / scale
    return found


def stacked(trials: Sequence[Signals], low_hz: float, high_hz: float) -> tuple[FloatArray, FloatArray, float]:
    """Columns (n, k) and effort (n,) of all trials in a band, in motion, and how long that lasts [s]."""
    stacks = [_band(trial, low_hz, high_hz) for trial in trials]
    columns = np.concatenate([stack[:-1] for stack in stacks], axis=1).T
    length_s = sum(stack.shape[1] / trial.rate_hz for stack, trial in zip(stacks, trials, strict=True))
    return columns, np.concatenate([stack[-1] for stack in stacks]), length_s


def load_kg(trial: Signals) -> float:
    """Of a trial; 0 where none is told."""
    load = trial.recording.conditions.get("load_kg", 0.0)
    return float(load) if isinstance(load, int | float) else 0.0


def _band(trial: Signals, low_hz: float, high_hz: float) -> FloatArray:
    position = low_pass(trial.position, high_hz, trial.rate_hz)
    speed = max(1e-12, 0.02 * float(np.quantile(np.abs(trial.velocity), 0.95)))
    direction, sine = np.tanh(trial.velocity / speed), np.sin(position)
    plain = [trial.acceleration, trial.velocity, direction, position, sine]
    with_load = [load_kg(trial) * column for column in (trial.acceleration, direction, sine)]
    stack = np.nan_to_num(np.array([*plain, *with_load, trial.effort]))
    moving = np.flatnonzero(trial.usable & (np.abs(trial.velocity) > speed))
    filtered = band_pass_thinned(stack, low_hz, high_hz, trial.rate_hz, moving)
    return np.ascontiguousarray(filtered.T)
