"""Dry friction that differs from run to run: part of the error that no model with one friction for all runs can know.

Every trial's own dry friction and offset are fitted to what the model leaves of the trial, of which it has not seen a
row. What they scatter more than their standard errors do (a variance component, by moments) differs from run to run.
Unlike the floor from repeated trials it needs none; but what is missing in the model may make it, too.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from compensator.lab.model.fit import Fit
from compensator.lab.model.validation import HeldOut, relative_error
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.screening.evidence import inflation_of

FEWEST_ROWS = 20  # of a trial
CHANCE = 0.01  # of so much scatter where friction is one and the same
LEAST_SHARE = 0.01  # of Coulomb friction


@dataclass(frozen=True, slots=True)
class FrictionByRun:
    """How dry friction differs between the trials that a model was not fitted to and those that it was.

    Attributes:
        scatter: root mean square over the trials, less what their standard errors make of it, in the effort's unit.
        share: of the model's Coulomb friction.
        trial: the one that differs most; difference: of its dry friction, in the effort's unit.
        trials: how many.
        floor: part of the held-out error that it makes, relative.
    """

    scatter: float
    share: float
    trial: str
    difference: float
    trials: int
    floor: float


def friction_by_run(fit: Fit, judged: HeldOut) -> FrictionByRun | None:
    """Judge a fit by its held-out rows; None where friction is one for all, or these rows cannot tell."""
    coulomb = next((float(t.coefficients[0]) for t in fit.terms if t.effect.name == "coulomb"), 0.0)
    if judged.kind == "leave-one-block-out" or coulomb <= 0.0:
        return None
    dataset = fit.dataset
    direction = dataset.stack([trial.motion.direction[None] for trial in dataset.trials])[judged.rows, 0]
    index, left = dataset.trial_index[judged.rows], judged.residual.copy()
    found: dict[int, tuple[float, float]] = {}
    for label in np.unique(index):
        own = index == label
        if int(own.sum()) >= FEWEST_ROWS and np.ptp(direction[own]) > 1.0:
            found[int(label)] = _difference(direction[own], judged.residual[own])
            left[own] -= found[int(label)][0] * direction[own]
    if not found:
        return None
    differences, errors = np.array(list(found.values())).T
    scatter = float(np.sqrt(max(np.mean(differences**2 - errors**2), 0.0)))
    chance = float(chi2.sf(np.sum((differences / errors) ** 2), len(found)))
    if chance > CHANCE or scatter < LEAST_SHARE * coulomb:
        return None
    most = max(found, key=lambda label: abs(found[label][0]))
    before, after = judged.relative, relative_error(left, judged.effort)
    return FrictionByRun(
        scatter=scatter,
        share=scatter / coulomb,
        trial=dataset.trials[most].signals.recording.name,
        difference=found[most][0],
        trials=len(found),
        floor=float(np.sqrt(max(before**2 - after**2, 0.0))),
    )


def by_run_in_words(found: FrictionByRun, unit: str) -> str:
    """One sentence."""
    where = f"in '{found.trial}'" if found.trials == 1 else f"over {found.trials} trials, most in '{found.trial}'"
    return (
        f"Dry friction differs from run to run by {found.scatter:.3g} {unit}, {found.share:.1%} of Coulomb friction, "
        f"{where} ({found.difference:+.3g} {unit}): {found.floor:.1%} of the effort, a floor for any model with one "
        "friction for all runs, unless what is missing makes it."
    )


def _difference(direction: FloatArray, residual: FloatArray) -> tuple[float, float]:
    """Dry friction of a trial's own beside an offset of its own, and its standard error."""
    columns = np.column_stack([direction, np.ones(len(direction))])
    solution = np.linalg.lstsq(columns, residual, rcond=None)[0]
    left = residual - columns @ solution
    swing = direction - direction.mean()
    noise = inflation_of(left) * float(left @ left) / (len(left) - 2)
    return float(solution[0]), max(float(np.sqrt(noise / (swing @ swing))), np.finfo(float).tiny)
