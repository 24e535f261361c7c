"""Coefficients refined by simulating the closed loop: the columns of the regression along the model's own motion.

Direct and inverse dynamic identification (Gautier, Janot, Vandanjon 2013, IEEE TCST 21): the joint is moved through
every trial by the model, the effort is regressed on columns along that motion, and so on until nothing changes. Noise
of the measured position does not get into the columns, and friction at reversals acts where the model has them.
"""

from dataclasses import dataclass

import numpy as np

from compensator.lab.closed_loop.loop_comparison import Laws, LoopComparison, compare_coefficients, compare_in_loop
from compensator.lab.closed_loop.simulation import moved_recording
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fit import fit_model
from compensator.lab.model.fitted import Fit, trained_trials
from compensator.lab.rows.assembly import more_trials

MOST_PASSES = 8
SETTLED = 1e-3  # change of the predicted effort along the measured motion, over that effort


@dataclass(frozen=True)
class Refinement:
    """A model before and after.

    Attributes:
        fit: along the simulated motion; None where no pass lowered the error of the effort in closed loop.
        before, after: in closed loop; the same where nothing was gained.
        passes: that were tried.
    """

    fit: Fit | None
    before: LoopComparison
    after: LoopComparison
    passes: int


def refine(fit: Fit, laws: Laws | None = None) -> Refinement:
    """Refine a model's coefficients; shapes stay. Of all passes, the one with the least error of the training effort.

    Args:
        fit: of the model.
        laws: as `compare_in_loop`.

    Raises:
        UnusableDataError: as `simulate`.
    """
    before = best = now = compare_in_loop(fit, laws)
    refined, last = None, fit.coefficients
    for count in range(1, MOST_PASSES + 1):
        try:
            along = _along(fit, now)
            now = compare_coefficients(fit, along, laws)
        except UnusableDataError:  # the model's joint hardly moves, or one of no inertia was found there
            return Refinement(refined, before, best, count)
        if now.training.effort < best.training.effort:
            refined, best = along, now
        change = fit.columns[fit.training] @ (along.coefficients - last)
        last = along.coefficients
        if float(np.linalg.norm(change)) <= SETTLED * float(np.linalg.norm(fit.dataset.effort[fit.training])):
            break
    return Refinement(refined, before, best, count)


def _along(fit: Fit, moved: LoopComparison) -> Fit:
    """The model fitted along the motion that it was simulated to make, to the training trials."""
    dataset = fit.dataset
    recordings = [
        moved_recording(dataset, trial, run.simulated.position)
        for trial, run in zip(dataset.trials, moved.trials, strict=True)
    ]
    along = more_trials(dataset, recordings).seen_by("moving")
    rows = along.in_regimes("moving")  # that of the model is known near its reversals, too
    return fit_model(
        along, fit.names, rows & np.isin(along.trial_index, trained_trials(dataset, fit.training)), fit.shapes
    )
