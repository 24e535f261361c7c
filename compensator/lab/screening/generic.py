"""Driver splines: what a missing effect looks like when no formula of the catalogue fits.

A seven-knot linear spline of each driving variable, once plain and once against the motion, and of what damping may
vary with once times the speed: a model-error model in Ljung's sense. It names the variable, not the mechanism.
"""

from collections.abc import Mapping

import numpy as np

from compensator.lab.effects.free_curve import WAYS, ways_of
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.reversals import slider
from compensator.lab.rows.dataset import Dataset, Trial
from compensator.lab.rows.drivers import DRIVERS, available
from compensator.lab.screening.base import DriverBlock

KNOTS = 7
KNOT_SHARES = np.linspace(0.0, 1.0, KNOTS)
SPLINED = ("position", "velocity", "acceleration", "load", "load_kg", "temperature", "time")


def driver_blocks(dataset: Dataset) -> list[DriverBlock]:
    """The splines of every driver that varies over the rows."""
    values = available(dataset)
    knots = {name: np.unique(np.quantile(values[name], KNOT_SHARES)) for name in SPLINED if name in values}
    stacked = dataset.stack(_all_hats(trial, knots) for trial in dataset.trials)
    ways = [(name, way) for name in knots for way in ways_of(name)]
    ends = np.cumsum([len(knots[name]) for name, _ in ways])[:-1]
    return [
        DriverBlock(name, way, columns, knots[name])
        for (name, way), columns in zip(ways, np.split(stacked, ends, axis=1) if ways else [], strict=True)
    ]


def _all_hats(trial: Trial, knots: Mapping[str, FloatArray]) -> FloatArray:
    """Hats of every driver of one trial, in every way that it may act, shape (k, n)."""
    hats = {name: _hats(DRIVERS[name].of(trial), places) for name, places in knots.items()}
    return np.concatenate([plain * WAYS[way](trial.motion) for name, plain in hats.items() for way in ways_of(name)])


def _hats(values: FloatArray, knots: FloatArray) -> FloatArray:
    """Linear hat functions of shape (len(knots), n); they sum to one, and are held beyond the outer knots."""
    return np.array([np.interp(values, knots, unit) for unit in np.eye(len(knots))])


SHARES = (0.06, 0.2, 0.6)  # of the travel: from beyond what surfaces give to what hardly slides


def hysteresis_columns(dataset: Dataset) -> FloatArray:
    """Sliders of every distance over all rows, filtered like the effort, shape (N, len(SHARES))."""
    motions = [trial.motion for trial in dataset.trials]
    return dataset.stack(
        np.array([slider(motion.strokes, share * motion.position_span) for share in SHARES]) for motion in motions
    )
