"""What a model leaves on rows that the filter brings nothing of a reversal to.

The final filter spreads what happens at a reversal to both sides, in the same way in every trial of one motion. What
reaches rows that slide so is small beside any effect, but follows speed, load or temperature, as reversals do, and is
no noise. To name an effect these rows are worth more than they mislead; that something is left, be it so small, must
hold without them.
"""

import numpy as np

from compensator.lab.left_over.left_over import LeftOver, left_over
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import BoolArray
from compensator.lab.recordings.regimes import within_spread
from compensator.lab.rows.dataset import Dataset
from compensator.lab.screening.candidates import Candidates, gather_curves
from compensator.lab.screening.clearing import with_noise

LEFT_SHARE = 0.8  # of the rows, at least: at a low cut-off the spread is most of a stroke, and few rows tell little


def left_for_sure(fit: Fit, gathered: Candidates) -> LeftOver | None:
    """What a model leaves on the rows that are judged; None where it is no more than noise, or of reversals alone.

    Args:
        fit: the model.
        gathered: what it may be missing.
    """
    left = left_over(gathered)
    if not left.is_more_than_noise:
        return None
    clear = fit.training & ~_reached(fit.dataset)
    if gathered.show_in != "sliding" or clear.sum() < LEFT_SHARE * fit.training.sum():
        return left
    again = with_noise(gather_curves(fit_model(fit.dataset, fit.names, clear, fit.shapes)))
    return left if left_over(again).is_more_than_noise else None


def _reached(dataset: Dataset) -> BoolArray:
    """Rows that something of a reversal reaches through the filter, shape (N,)."""
    reached = []
    for trial in dataset.trials:
        signals = trial.signals
        reached.append(within_spread(signals.velocity, dataset.scales.slow, signals.rate_hz, dataset.cutoff_hz))
    return np.concatenate([own[trial.picked] for own, trial in zip(reached, dataset.trials, strict=True)])
