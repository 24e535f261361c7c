"""Experiments and trials that the tests of the store begin."""

import numpy as np

from bench.store import Store, TrialWriter

CHANNELS = ("time_s", "position_rad", "duty")


def begin(store: Store, kind: str = "steps", source: str = "simulated") -> int:
    return store.begin_experiment(kind, {"count": 3}, source, {"seed": 1}, {"name": "paper"}, "Ada", "first")


def begin_trial(
    store: Store, experiment_id: int, name: str = "step 1", **conditions: float | str | bool
) -> TrialWriter:
    return store.begin_trial(experiment_id, name, "step", conditions, CHANNELS)


def rows(first: int, count: int) -> np.ndarray:
    """Rows that tell which they are: time rises by 1, position is the negative of it, duty is unknown."""
    time_s = np.arange(first, first + count, dtype=np.float64)
    return np.column_stack([time_s, -time_s, np.full(count, np.nan)])
