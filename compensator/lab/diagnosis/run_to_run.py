"""What differs from run to run: part of the error that no model with one friction and one zero for all runs can know.

Every trial's own dry friction and offset are fitted to what the model leaves of the trial, of which it has not seen a
row. What they scatter more than their standard errors do (a variance component, by moments) differs from run to run.
Unlike the floor from repeated trials it needs none; but what is missing in the model may make it, too.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import HeldOut, relative_error
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.evidence import inflation_of

FEWEST_ROWS = 20  # of a trial
CHANCE = 0.01  # of so much scatter where it is one and the same
LEAST_SHARE = 0.01  # of Coulomb friction

DRY_FRICTION, CONSTANT = "Dry friction", "A constant force, or the zero of the effort,"


@dataclass(frozen=True, slots=True)
class ByRun:
    """How a constant differs between the trials that a model was not fitted to and those that it was.

    Attributes:
        what: DRY_FRICTION or CONSTANT.
        scatter: root mean square over the trials, less what their standard errors make of it, in the effort's unit.
        share: of the model's Coulomb friction.
        trial: the one that differs most; difference: of its constant, in the effort's unit.
        trials: how many.
        floor: part of the held-out error that it makes, relative.
    """

    what: str
    scatter: float
    share: float
    trial: str
    difference: float
    trials: int
    floor: float


def differences_by_run(fit: Fit, judged: HeldOut) -> list[ByRun]:
    """Judge a fit by its held-out rows: what differs, first what makes more of the error.

    Nothing where all is one for all runs, where these rows cannot tell, or without Coulomb friction to measure it by.
    """
    coulomb = next((float(t.coefficients[0]) for t in fit.terms if t.effect.name == "coulomb"), 0.0)
    if judged.kind == "leave-one-block-out" or coulomb <= 0.0:
        return []
    dataset = fit.dataset
    direction = dataset.stack([trial.motion.direction[None] for trial in dataset.trials])[judged.rows, 0]
    index = dataset.trial_index[judged.rows]
    found = {
        int(label): _differences(direction[index == label], judged.residual[index == label])
        for label in np.unique(index)
        if int((index == label).sum()) >= FEWEST_ROWS and np.ptp(direction[index == label]) > 1.0
    }
    if not found:
        return []
    columns = {DRY_FRICTION: direction, CONSTANT: np.ones(len(direction))}
    told = [
        _by_run(what, [own[place] for own in found.values()], list(found), coulomb, fit, judged, column)
        for place, (what, column) in enumerate(columns.items())
    ]
    return sorted((one for one in told if one is not None), key=lambda one: -one.floor)


def by_run_in_words(found: ByRun, unit: str) -> str:
    """One sentence."""
    where = f"in '{found.trial}'" if found.trials == 1 else f"over {found.trials} trials, most in '{found.trial}'"
    of_friction = f", {found.share:.1%} of Coulomb friction" if found.what == DRY_FRICTION else ""
    one = "friction" if found.what == DRY_FRICTION else "zero"
    return (
        f"{found.what} differs from run to run by {found.scatter:.3g} {unit}{of_friction}, {where} "
        f"({found.difference:+.3g} {unit}): {found.floor:.1%} of the effort, a floor for any model with one {one} for "
        "all runs, unless what is missing makes it."
    )


def _by_run(
    what: str,
    own: list[tuple[float, float]],
    labels: list[int],
    coulomb: float,
    fit: Fit,
    judged: HeldOut,
    column: FloatArray,
) -> ByRun | None:
    """One constant, of each trial with its standard error; None where it is the same in all, as far as they tell."""
    differences, errors = np.array(own).T
    scatter = float(np.sqrt(max(np.mean(differences**2 - errors**2), 0.0)))
    chance = float(chi2.sf(np.sum((differences / errors) ** 2), len(own)))
    if chance > CHANCE or scatter < LEAST_SHARE * coulomb:
        return None
    index, left = fit.dataset.trial_index[judged.rows], judged.residual.copy()
    for label, difference in zip(labels, differences, strict=True):
        left[index == label] -= difference * column[index == label]
    most = int(np.argmax(np.abs(differences)))
    before, after = judged.relative, relative_error(left, judged.effort)
    if after >= before:
        return None  # of two that few rows can hardly tell apart, this one alone is no part of the error
    return ByRun(
        what=what,
        scatter=scatter,
        share=scatter / coulomb,
        trial=fit.dataset.trials[labels[most]].signals.recording.name,
        difference=float(differences[most]),
        trials=len(own),
        floor=float(np.sqrt(before**2 - after**2)),
    )


def _differences(direction: FloatArray, residual: FloatArray) -> tuple[tuple[float, float], tuple[float, float]]:
    """Dry friction and offset of a trial's own, fitted beside each other, each with its standard error."""
    columns = np.column_stack([direction, np.ones(len(direction))])
    solution = np.linalg.lstsq(columns, residual, rcond=None)[0]
    left = residual - columns @ solution
    noise = inflation_of(left) * float(left @ left) / (len(left) - 2)
    errors = np.sqrt(noise * np.diag(np.linalg.inv(columns.T @ columns)))
    least = np.finfo(float).tiny
    friction, offset = zip(solution.tolist(), np.maximum(errors, least).tolist(), strict=True)
    return friction, offset
