"""Driver splines: what a missing effect looks like when no formula of the catalogue fits.

A seven-knot linear spline of each driving variable, once plain and once against the motion: a model-error model in
Ljung's sense. It names the variable, not the mechanism.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.dataset import Dataset
from compensator.lab.drivers import DRIVERS, available
from compensator.lab.recording import FloatArray

KNOTS = 7
SPLINED = ("position", "velocity", "acceleration", "load", "load_kg", "temperature", "time")


@dataclass(frozen=True)
class DriverBlock:
    """One driver's spline over all rows.

    Attributes:
        driver: key of `DRIVERS`.
        against_motion: multiplied by the direction of motion (friction-like), or plain (force-like).
        columns: filtered like the effort, shape (N, k).
        knots: of the spline, in the driver's unit, shape (k,).
    """

    driver: str
    against_motion: bool
    columns: FloatArray
    knots: FloatArray


def driver_blocks(dataset: Dataset) -> list[DriverBlock]:
    """The splines of every driver that varies over the rows."""
    values = available(dataset)
    blocks = []
    for name in SPLINED:
        if name not in values:
            continue
        knots = np.unique(np.quantile(values[name], np.linspace(0.0, 1.0, KNOTS)))
        for against in (False, True):
            full = [
                _hats(DRIVERS[name].of(trial), knots) * (trial.motion.direction if against else 1.0)
                for trial in dataset.trials
            ]
            blocks.append(DriverBlock(name, against, dataset.stack(full), knots))
    return blocks


def _hats(values: FloatArray, knots: FloatArray) -> FloatArray:
    """Linear hat functions of shape (len(knots), n); they sum to one, and are held beyond the outer knots."""
    return np.array([np.interp(values, knots, unit) for unit in np.eye(len(knots))])
