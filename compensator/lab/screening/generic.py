"""Free curves: what a missing effect looks like when no formula of the catalogue fits.

A seven-knot linear spline of each driving variable, once plain and once against the motion, and of what damping may
vary with once times the speed: a model-error model in Ljung's sense. It names the variable, not the mechanism. And a
free hysteresis of position: elastic sliders that give way at shares of the travel, for what bends along and slides.
"""

from collections.abc import Mapping

import numpy as np

from compensator.lab.effects.free_curve import KNOTS, WAYS, ways_of
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.recordings.reversals import slider
from compensator.lab.rows.dataset import Dataset, Trial
from compensator.lab.rows.drivers import DRIVERS, available
from compensator.lab.screening.base import HYSTERESIS_DRIVER

KNOT_SHARES = np.linspace(0.0, 1.0, KNOTS)
SPLINED = ("position", "velocity", "acceleration", "load", "load_kg", "temperature", "time", "session_time")
SHARES = (0.06, 0.2, 0.6)  # of the travel: from beyond what surfaces give to what hardly slides


def free_curves(dataset: Dataset) -> dict[str, FloatArray]:
    """Columns (N, k) of every curve over all rows, filtered like the effort, by its variable and its way.

    Over every variable that varies over the rows, and a hysteresis where the joint turns back.
    """
    knots = knots_of(dataset)
    columns = {f"{name}{way}": len(knots[name]) for name in knots for way in ways_of(name)}
    stacked = dataset.stack(_all_hats(trial, knots) for trial in dataset.trials) if columns else np.empty((0, 0))
    found = dict(zip(columns, np.split(stacked, np.cumsum(list(columns.values()))[:-1], axis=1), strict=True))
    return found | ({HYSTERESIS_DRIVER: hysteresis_columns(dataset)} if _turns_back(dataset) else {})


def knots_of(dataset: Dataset) -> dict[str, FloatArray]:
    """Where the splines have their knots, in each variable's unit: at quantiles over the rows."""
    values = available(dataset)
    return {name: np.unique(np.quantile(values[name], KNOT_SHARES)) for name in SPLINED if name in values}


def _all_hats(trial: Trial, knots: Mapping[str, FloatArray]) -> FloatArray:
    """Hats of every driver of one trial, in every way that it may act, shape (k, n)."""
    hats = {name: _hats(DRIVERS[name].of(trial), places) for name, places in knots.items()}
    return np.concatenate([plain * WAYS[way](trial.motion) for name, plain in hats.items() for way in ways_of(name)])


def _hats(values: FloatArray, knots: FloatArray) -> FloatArray:
    """Linear hat functions of shape (len(knots), n); they sum to one, and are held beyond the outer knots."""
    return np.array([np.interp(values, knots, unit) for unit in np.eye(len(knots))])


def hysteresis_columns(dataset: Dataset) -> FloatArray:
    """Sliders of every distance over all rows, filtered like the effort, shape (N, len(SHARES))."""
    motions = [trial.motion for trial in dataset.trials]
    return dataset.stack(
        np.array([slider(motion.strokes, share * motion.position_span) for share in SHARES]) for motion in motions
    )


def _turns_back(dataset: Dataset) -> bool:
    """Whether any trial slides both ways: nothing bends back and forth along with a shaft that turns on."""
    ways = np.sign(dataset.rows_of([trial.motion.velocity for trial in dataset.trials]))
    sliding = dataset.in_regimes("sliding")
    trials = [set(dataset.trial_index[sliding & (ways == way)].tolist()) for way in (1.0, -1.0)]
    return bool(trials[0] & trials[1])
