"""Whether there are rows enough near reversals. One count for all who ask."""

import numpy as np

from compensator.lab.effects.catalogue import candidates
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.regimes import Regime

FEWEST_REVERSAL_ROWS = 40


def few_reversals(fit: Fit) -> dict[str, str] | None:
    """Effect with memory that a model does not have -> how few rows it has; None where there are enough."""
    dataset = fit.dataset
    trained = np.isin(dataset.trial_index, np.unique(dataset.trial_index[fit.training]))
    count = int((trained & (dataset.regime == Regime.TRANSIENT)).sum())
    if count >= FEWEST_REVERSAL_ROWS:
        return None
    why = f"needs reversals and starts: {count} rows lie near one, wanted {FEWEST_REVERSAL_ROWS}; record "
    wanted = [effect for effect in candidates(fit.names, dataset.facts) if effect.rows == "moving"]
    return {effect.name: f"{effect.name} {why}{effect.excited_by}" for effect in wanted}
