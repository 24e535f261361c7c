"""The picture that shows why an effect is ranked: partial residual over its driving variable, with its curve."""

import numpy as np

from compensator.lab.diagnosis.diagnosis import Picture
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.rows.picture import binned_mean
from compensator.lab.screening.candidates import Candidates
from compensator.lab.screening.evidence import Evidence


def picture_of(gathered: Candidates, item: Evidence) -> Picture | None:
    """Partial residual and curve over the effect's driver, on the tested rows; None where that is not measured."""
    dataset, rows = gathered.fit.dataset, gathered.rows
    driver = DRIVERS[effect_named(item.block.name).driver]
    values = dataset.rows_of([driver.of(trial) for trial in dataset.trials])[rows]
    if not np.isfinite(values).all():
        return None
    residual, curve = _partial_residual(gathered, item)
    motion = np.sign(dataset.rows_of([trial.motion.direction for trial in dataset.trials])[rows])
    against = driver.name != "velocity" and _spread(values, curve * motion) > _spread(values, curve)
    sign = motion if against else np.ones(len(values))
    stretch = dataset.block_index[rows]
    return Picture(
        driver.name, against, binned_mean(values, residual * sign, stretch), binned_mean(values, curve * sign, stretch)
    )


def _partial_residual(gathered: Candidates, item: Evidence) -> tuple[FloatArray, FloatArray]:
    """What the model with the effect leaves plus the effect's own contribution, and that contribution, both (n,).

    The effect's whole column is drawn, not only its part that no other column explains: that is the shape one knows.
    """
    base, columns = gathered.as_measured(item.block.base), item.block.columns
    if gathered.noise is not None:
        columns = gathered.noise.as_measured(columns)
    projected = columns - base.basis @ (base.basis.T @ columns)
    coefficients = np.linalg.lstsq(projected, base.residual, rcond=1e-6)[0]
    curve = columns @ coefficients / gathered.weights
    left = (base.residual - projected @ coefficients) / gathered.weights
    return left + curve, curve


def _spread(driver: FloatArray, values: FloatArray) -> float:
    """Power of the binned means: how much of the values the driver explains."""
    means = binned_mean(driver, values, np.arange(len(values)))
    return float(np.sum(means.count * means.mean**2))
