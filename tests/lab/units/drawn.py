"""Units whose true values are known: drawn from normal distributions, with errors as a few trials would tell them."""

import numpy as np

from compensator.lab.units.random_effects import UnitValues


def drawn(random: np.random.Generator, units: int, scatter: float, error: float, trials: int) -> UnitValues:
    """One quantity of mean 1; each unit's value is the mean of its trials, its error what the trials say of that.

    Args:
        random: where they come from.
        units: how many.
        scatter: standard deviation of the true values.
        error: standard error of each.
        trials: of each unit.
    """
    truth = 1.0 + scatter * random.standard_normal(units)
    each = truth[:, None] + error * np.sqrt(trials) * random.standard_normal((units, trials))
    told = np.std(each, axis=1, ddof=1) / np.sqrt(trials)
    return UnitValues(np.mean(each, axis=1), told, np.full(units, trials - 1.0))
