"""What differs from run to run: part of the error that no model with one friction and one zero for all runs can know.

Every trial's own dry friction and offset, and its weight where nobody told what hangs at the arm, are fitted to what
the model leaves of the trial, of which it has not seen a row. What they scatter more than their standard errors do (a
variance component, by moments) differs from run to run. Unlike the floor from repeated trials it needs none; but what
is missing in the model may make it, too.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from compensator.lab.chance import SIGNIFICANT
from compensator.lab.model.fitted import Fit
from compensator.lab.model.held_out_error import HeldOut, relative_error
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.rows.dataset import FEWEST_ROWS
from compensator.lab.screening.evidence import inflation_of

LEAST_SHARE = 0.01  # of Coulomb friction

DRY_FRICTION, CONSTANT = "Dry friction", "A constant force, or the zero of the effort,"
WEIGHT = "The weight that the joint carries"
ONE_FOR_ALL = {DRY_FRICTION: "friction", CONSTANT: "zero", WEIGHT: "weight"}
ASK_LOADS = " Were other loads hung? Tell load_kg of each trial."


@dataclass(frozen=True, slots=True)
class ByRun:
    """How a constant differs between the trials that a model was not fitted to and those that it was.

    Attributes:
        what: DRY_FRICTION, CONSTANT or WEIGHT.
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
    columns = {DRY_FRICTION: direction, CONSTANT: dataset.constant[judged.rows], **_untold_weight(fit, judged.rows)}
    together = np.column_stack(list(columns.values()))
    index = dataset.trial_index[judged.rows]
    found = {
        int(label): _differences(together[index == label], judged.residual[index == label])
        for label in np.unique(index)
        if int((index == label).sum()) >= FEWEST_ROWS and np.ptp(direction[index == label]) > 1.0
    }
    if not found:
        return []
    told = [
        _by_run(what, [own[place] for own in found.values()], list(found), coulomb, fit, judged, column)
        for place, (what, column) in enumerate(columns.items())
    ]
    return sorted((one for one in told if one is not None), key=lambda one: -one.floor)


def by_run_in_words(found: ByRun, unit: str) -> str:
    """One sentence."""
    where = f"in '{found.trial}'" if found.trials == 1 else f"over {found.trials} trials, most in '{found.trial}'"
    of_friction = f", {found.share:.1%} of Coulomb friction" if found.what == DRY_FRICTION else ""
    one, ask = ONE_FOR_ALL[found.what], ASK_LOADS if found.what == WEIGHT else ""
    return (
        f"{found.what} differs from run to run by {found.scatter:.3g} {unit}{of_friction}, {where} "
        f"({found.difference:+.3g} {unit}): {found.floor:.1%} of the effort, a floor for any model with one {one} for "
        f"all runs, unless what is missing makes it.{ask}"
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
    if chance > SIGNIFICANT or scatter < LEAST_SHARE * coulomb:
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


def _untold_weight(fit: Fit, rows: BoolArray) -> dict[str, FloatArray]:
    """Column of the weight, 1 where it pulls most; none where loads are told, or the model has no gravity."""
    told = any("load_kg" in trial.motion.conditions for trial in fit.dataset.trials)
    gravity = next((term for term in fit.terms if term.effect.name == "gravity"), None)
    if told or gravity is None:
        return {}
    column = fit.dataset.columns(gravity.effect, gravity.shape)[rows, 0]
    most = float(np.abs(column).max(initial=0.0))
    return {WEIGHT: column / most} if most > 0.0 else {}


def _differences(columns: FloatArray, residual: FloatArray) -> list[tuple[float, float]]:
    """A trial's own constants, fitted beside each other, each with its standard error.

    Args:
        columns: shape (n, constants); what a trial's motion cannot tell apart has a wide error.
        residual: shape (n,).
    """
    solution = np.linalg.lstsq(columns, residual, rcond=None)[0]
    left = residual - columns @ solution
    noise = inflation_of(left) * float(left @ left) / (len(left) - columns.shape[1])
    errors = np.sqrt(noise * np.diag(np.linalg.pinv(columns.T @ columns, hermitian=True)))
    return list(zip(solution.tolist(), np.maximum(errors, np.finfo(float).tiny).tolist(), strict=True))
