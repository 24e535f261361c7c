"""Which effects have too few rows to be judged: near reversals, or starts from rest. One count for all who ask."""

import numpy as np

from compensator.lab.at_rest.breakaway_comparison import FEWEST_STARTS
from compensator.lab.at_rest.breakaway_rows import BreakawayRows, breakaway_rows, shares_of
from compensator.lab.effects.catalogue import candidates
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.regimes import Regime

FEWEST_REVERSAL_ROWS = 40


def few_rows(fit: Fit) -> dict[str, str]:
    """Effect name -> which rows it has too few of, and what to record; of all effects that a model does not have."""
    return {**(few_reversals(fit) or {}), **(few_starts(fit, breakaway_rows(fit)) or {})}


def few_reversals(fit: Fit) -> dict[str, str] | None:
    """The same of effects with memory, near reversals; None where there are rows enough."""
    dataset = fit.dataset
    trained = np.isin(dataset.trial_index, np.unique(dataset.trial_index[fit.training]))
    count = int((trained & (dataset.regime == Regime.TRANSIENT)).sum())
    if count >= FEWEST_REVERSAL_ROWS:
        return None
    why = f"needs reversals and starts: {count} rows lie near one, wanted {FEWEST_REVERSAL_ROWS}; record "
    wanted = [effect for effect in candidates(fit.names, dataset.facts) if effect.rows == "moving"]
    return {effect.name: f"{effect.name} {why}{effect.excited_by}" for effect in wanted}


def few_starts(fit: Fit, rows: BreakawayRows | None) -> dict[str, str] | None:
    """The same of effects that show at starts from rest alone; None where there are rows enough."""
    count = starts_counted(rows)
    if rows is not None and count >= FEWEST_STARTS:
        return None
    why = f"{count} starts from rest whose effort is known, wanted {FEWEST_STARTS}; record breakaway ramps: "
    wanted = [effect for effect, _ in shares_of(candidates(fit.names, fit.dataset.facts)) if effect.rows == "breakaway"]
    return {effect.name: f"{effect.name} needs more: {why}{effect.excited_by}" for effect in wanted}


def starts_counted(rows: BreakawayRows | None) -> int:
    """How many starts from rest whose effort is known a model is fitted to."""
    return 0 if rows is None else int(rows.training.sum())
