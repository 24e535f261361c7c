"""Breakaway effort over what drives it: the rest before, the rate, the load."""

import numpy as np

from compensator.lab.at_rest.breakaway_regression import BreakawayFit
from compensator.lab.diagnosis.diagnosis import Picture
from compensator.lab.effects.effect import Effect
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.picture import SIGMAS, BinnedMean

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
        if not len(group):
            continue
        mean = float(values[group].mean())
        half = SIGMAS * float(np.std(values[group], ddof=1)) / np.sqrt(len(group)) if len(group) > 1 else float("nan")
        table.append((float(driver[group].mean()), mean, mean - half, mean + half, len(group)))
    x, mean_, low, high, count = np.array(table).T
    return BinnedMean(x, mean_, low, high, count.astype(np.int64))
