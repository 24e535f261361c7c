"""How wrong a model is on trials that it was not fitted to.

Held-out trials where the study names some; else each training trial is left out in turn. Normal equations are kept
per trial, so leaving one out costs one small solve. Nonlinear shapes stay those of the whole training set.
"""

from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from compensator.lab.model.fitted import Fit, trained_trials
from compensator.lab.model.linear import solve_without
from compensator.lab.model.prediction import beyond_tangent
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import RowChoice

UNDETERMINED = 1e-9  # share of what all trials tell of a coefficient below which the others know nothing of it
FEWEST_TRIALS = 4  # fewer cannot be resampled or left out one by one

HeldOutKind = Literal["hold-out", "leave-one-trial-out", "leave-one-block-out"]


@dataclass(frozen=True)
class HeldOut:
    """Residuals on rows that the coefficients have not seen.

    Attributes:
        kind: how rows were held out.
        rows: which rows, shape (N,).
        residual: of those rows, shape (rows.sum(),).
        effort: measured, of those rows.
        unit: which independent unit (trial or block) each of these rows belongs to.
        relative: root of residual power over effort power.
        rms: root mean square residual, in the effort's unit.
        doubt: variance of each row's prediction for not knowing the coefficients any better, over that of its noise;
            none where a study names what is held out.
    """

    kind: HeldOutKind
    rows: BoolArray
    residual: FloatArray
    effort: FloatArray
    unit: IntArray
    relative: float
    rms: float
    doubt: FloatArray = field(default_factory=lambda: np.zeros(1))

    def weighted(self, weight: FloatArray) -> "HeldOut":
        """The same, each of these rows multiplied by a weight."""
        residual, effort = weight * self.residual, weight * self.effort
        return replace(
            self, residual=residual, effort=effort, relative=relative_error(residual, effort), rms=rms(residual)
        )

    def power_by_unit(self) -> FloatArray:
        """Sum of squared residuals of each independent unit, in order of its label."""
        return self._by_unit(self.residual)

    def effort_power_by_unit(self) -> FloatArray:
        """Sum of squared efforts of each independent unit, in order of its label."""
        return self._by_unit(self.effort)

    def _by_unit(self, values: FloatArray) -> FloatArray:
        _, dense = np.unique(self.unit, return_inverse=True)
        return np.bincount(dense, weights=values**2).astype(float)


def relative_error(residual: FloatArray, effort: FloatArray) -> float:
    """||residual|| / ||effort||."""
    power = float(effort @ effort)
    return float(np.sqrt((residual @ residual) / power)) if power > 0 else float("nan")


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")


def held_out(fit: Fit, rows: RowChoice | None = None, weight: FloatArray | None = None) -> HeldOut:
    """The held-out error of a fit: on the trials it was not trained on, or by leaving one out in turn.

    With fewer than four training trials and none held out, stretches of BLOCK_S are left out instead: an optimistic
    stand-in, since a trial's stretches share its conditions; `kind` says so.

    Args:
        fit: to be judged.
        rows: that are judged; None takes the study's.
        weight: of each row's residual and effort, shape (N,), for models to be held against each other by what they
            know well (see `Dataset.steadiness`); None: all count alike.
    """
    found = _held_out(fit, fit.dataset.in_regimes(rows or fit.dataset.rows))
    return found if weight is None else found.weighted(weight[found.rows])


def _held_out(fit: Fit, judged: BoolArray) -> HeldOut:
    trials = fit.dataset.trial_index
    trained = trained_trials(fit.dataset, fit.training)
    outside = judged & ~np.isin(trials, trained)
    if outside.any():
        return _result(fit, "hold-out", outside, fit.residual[outside], independent_units(fit, outside))
    if len(np.unique(trials[fit.training & judged])) >= FEWEST_TRIALS:
        return _leave_out(fit, "leave-one-trial-out", trials, judged)
    return _leave_out(fit, "leave-one-block-out", fit.dataset.block_index, judged)


def independent_units(fit: Fit, rows: BoolArray) -> IntArray:
    """Labels of what is resampled: trials, or stretches of BLOCK_S where there are too few trials."""
    trials = fit.dataset.trial_index[rows]
    return trials if len(np.unique(trials)) >= FEWEST_TRIALS else fit.dataset.block_index[rows]


def on_even_terms(one: HeldOut, other: HeldOut) -> tuple[HeldOut, HeldOut]:
    """Two models' errors on the same rows, each row counting by how well either model could predict it.

    Where a trial is the only one to tell of a coefficient, as the only one without load does of the arm alone, what the
    others make of it is a guess by any model, and would outweigh all that they do know: weights are those of errors of
    known variance (Aitken 1935), the larger of the two models'. Trials that are alike are left as they are.
    """
    weight = 1.0 / np.sqrt(1.0 + np.broadcast_to(np.maximum(one.doubt, other.doubt), one.residual.shape))
    first, second = (replace(error.weighted(weight), doubt=np.zeros(1)) for error in (one, other))
    return first, second


def _leave_out(fit: Fit, kind: HeldOutKind, units: IntArray, judged: BoolArray) -> HeldOut:
    rows = fit.training & judged
    kept = np.concatenate([term.kept for term in fit.terms])
    columns, effort = fit.training_equations
    columns, unit = columns[:, kept], units[fit.training]
    bounds = fit.bounds.of(kept)
    gram, moment = columns.T @ columns, columns.T @ effort
    residual, doubt = np.zeros(len(units)), np.zeros(len(unit))
    for label in np.unique(unit):
        own = unit == label
        inside = columns[own]
        rest = solve_without((gram, moment), (inside.T @ inside, inside.T @ effort[own]), bounds)
        seen = rows & (units == label)
        residual[seen] = fit.target[seen] - fit.columns[seen][:, kept] @ rest
        doubt[own] = _doubt(inside, gram)
        if fit.dataset.is_bent and seen.any():
            residual[seen] -= _beyond_tangent(fit, kept, rest, seen)
    return replace(_result(fit, kind, rows, residual[rows], units[rows]), doubt=doubt[rows[fit.training]])


def _doubt(own: FloatArray, whole: FloatArray) -> FloatArray:
    """Variance of predictions of weighted rows (n, k) by all others, over that of the noise.

    Args:
        own: the rows that are left out.
        whole: normal equations of all rows, these included, shape (k, k).
    """
    scale = 1.0 / np.sqrt(np.maximum(np.diag(whole), np.finfo(float).tiny))
    own = own * scale
    values, vectors = np.linalg.eigh(whole * np.outer(scale, scale) - own.T @ own)
    found: FloatArray = (own @ vectors) ** 2 @ (1.0 / np.maximum(values, UNDETERMINED))
    return found


def _beyond_tangent(fit: Fit, kept: BoolArray, coefficients: FloatArray, rows: BoolArray) -> FloatArray:
    """What straight columns miss where the model bends, with other coefficients (k,), on chosen rows (N,)."""
    trials = fit.dataset.trial_index
    whole = np.zeros(len(kept))
    whole[kept] = coefficients
    return np.concatenate(
        [beyond_tangent(fit.dataset, fit.terms, i, whole)[rows[trials == i]] for i in np.unique(trials[rows])]
    )


def _result(fit: Fit, kind: HeldOutKind, rows: BoolArray, residual: FloatArray, unit: IntArray) -> HeldOut:
    effort = fit.dataset.effort[rows]
    return HeldOut(kind, rows, residual, effort, unit, relative_error(residual, effort), rms(residual))
