"""The picture that shows why an effect is ranked: partial residual over its driving variable, with its curve."""

import numpy as np

from compensator.lab.at_rest.breakaway_regression import BreakawayFit
from compensator.lab.diagnosis.diagnosis import Picture
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Effect
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.drivers import DRIVERS
from compensator.lab.rows.picture import SIGMAS, BinnedMean, binned_mean, bins_of
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
    projected = base.beyond(columns)
    coefficients = np.linalg.lstsq(projected, base.residual, rcond=1e-6)[0]
    curve = columns @ coefficients / gathered.weights
    left = (base.residual - projected @ coefficients) / gathered.weights
    return left + curve, curve


def _spread(driver: FloatArray, values: FloatArray) -> float:
    """Power of the binned means: how much of the values the driver explains."""
    label = bins_of(driver)
    return float(np.sum(np.bincount(label, values) ** 2 / np.maximum(np.bincount(label), 1)))


MOST_GROUPS = 8
ALIKE = 0.1  # relative: values of a driver that are one


def picture_of_breakaway(fit: BreakawayFit, effect: Effect) -> Picture | None:
    """What the effect has to explain of the breakaway effort, and its own curve; None where starts lack its driver."""
    share = effect.breakaway
    values = fit.rows.driver(share.driver) if share is not None else None
    coefficients = fit.coefficients_of(effect.name)
    if share is None or values is None or coefficients is None or not np.isfinite(values).all():
        return None
    shape = next(one.shape for one in fit.shares if one.name == effect.name)
    curve = fit.rows.columns(share, shape) @ coefficients
    against = share.driver not in ("position", "direction")
    sign = fit.rows.direction if against else np.ones(len(curve))
    residual = grouped(values, (fit.residual + curve) * sign)
    return Picture(share.driver, against, residual, grouped(values, curve * sign))


def grouped(driver: FloatArray, values: FloatArray) -> BinnedMean:
    """Means of values (E,) in groups of like values of the driver (E,)."""
    order = np.argsort(driver)
    steps = np.diff(driver[order])
    cuts = np.flatnonzero(steps > ALIKE * np.maximum(np.abs(driver[order][1:]), 1e-12)) + 1
    groups = np.split(order, cuts)
    if len(groups) > MOST_GROUPS:
        groups = np.array_split(order, MOST_GROUPS)
    table = []
    for group in groups:
        mean = float(values[group].mean())
        half = SIGMAS * float(np.std(values[group], ddof=1)) / np.sqrt(len(group)) if len(group) > 1 else float("nan")
        table.append((float(driver[group].mean()), mean, mean - half, mean + half, len(group)))
    x, mean_, low, high, count = np.array(table).T
    return BinnedMean(x, mean_, low, high, count.astype(np.int64))
