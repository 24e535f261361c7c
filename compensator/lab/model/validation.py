"""How wrong a model is on trials that it was not fitted to.

Held-out trials where the study names some; else each training trial is left out in turn. Normal equations are kept
per trial, so leaving one out costs one small solve. Nonlinear shapes stay those of the whole training set.
"""

import numpy as np

from compensator.lab.model.fitted import Fit, trained_trials
from compensator.lab.model.held_out_error import HeldOut, HeldOutKind, relative_error, rms
from compensator.lab.model.linear import solve_without
from compensator.lab.model.prediction import beyond_tangent
from compensator.lab.model.weights import weights_of
from compensator.lab.recordings.recording import BoolArray, FloatArray, IntArray
from compensator.lab.rows.dataset import BLOCK_S, RowChoice

UNDETERMINED = 1e-9  # share of what all trials tell of a coefficient below which the others know nothing of it
FEWEST_TRIALS = 4  # fewer cannot be resampled or left out one by one


def held_out(fit: Fit, rows: RowChoice | None = None) -> HeldOut:
    """The held-out error of a fit: on the trials it was not trained on, or by leaving one out in turn.

    With fewer than four training trials and none held out, stretches of BLOCK_S are left out instead: an optimistic
    stand-in, since a trial's stretches share its conditions; `kind` says so.

    Args:
        fit: to be judged.
        rows: that are judged; None takes the study's.
    """
    choice = rows or fit.dataset.rows
    if choice not in fit.judged:
        fit.judged[choice] = _held_out(fit, fit.dataset.in_regimes(choice))
    return fit.judged[choice]


def few_trials(fit: Fit) -> str:
    """What the held-out error of a fit is worth where its trials are too few; empty where they are not."""
    if held_out(fit).kind != "leave-one-block-out":
        return ""
    return f"Too few trials to hold one out: stretches of {BLOCK_S:g} s are left out instead, which flatters the model."


def _held_out(fit: Fit, judged: BoolArray) -> HeldOut:
    """On rows of chosen regimes, shape (N,)."""
    trials = fit.dataset.trial_index
    trained = trained_trials(fit.dataset, fit.training)
    outside = judged & ~np.isin(trials, trained)
    if outside.any():
        unit = independent_units(fit, outside)
        return _result(fit, "hold-out", outside, fit.residual[outside], unit, np.zeros(len(unit)))
    if len(np.unique(trials[fit.training & judged])) >= FEWEST_TRIALS:
        return _leave_out(fit, "leave-one-trial-out", trials, judged)
    return _leave_out(fit, "leave-one-block-out", fit.dataset.block_index, judged)


def independent_units(fit: Fit, rows: BoolArray) -> IntArray:
    """Labels of what is resampled: trials, or stretches of BLOCK_S where there are too few trials."""
    trials = fit.dataset.trial_index[rows]
    return trials if len(np.unique(trials)) >= FEWEST_TRIALS else fit.dataset.block_index[rows]


def _leave_out(fit: Fit, kind: HeldOutKind, units: IntArray, judged: BoolArray) -> HeldOut:
    rows = fit.training & judged
    kept = np.concatenate([term.kept for term in fit.terms])
    columns, effort = fit.training_equations
    columns, unit = columns[:, kept], units[fit.training]
    bounds = fit.bounds.of(kept)
    gram, moment = columns.T @ columns, columns.T @ effort
    residual, doubt = np.zeros(len(units)), np.zeros(len(unit))
    judged_rows = np.flatnonzero(rows)
    seen_of = _by_label(units[judged_rows])
    for label, own in _by_label(unit).items():
        seen = judged_rows[seen_of.get(label, [])]
        inside = columns[own]
        rest = solve_without((gram, moment), (inside.T @ inside, inside.T @ effort[own]), bounds)
        residual[seen] = fit.target[seen] - fit.columns[seen][:, kept] @ rest
        doubt[own] = _doubt(inside, gram)
        if fit.dataset.is_bent and len(seen):
            residual[seen] -= _beyond_tangent(fit, kept, rest, rows & (units == label))
    return _result(fit, kind, rows, residual[rows], units[rows], doubt[rows[fit.training]])


def _by_label(labels: IntArray) -> dict[int, IntArray]:
    """Where each label stands (n,), in order."""
    order = np.argsort(labels, kind="stable")
    found, first = np.unique(labels[order], return_index=True)
    return dict(zip(found.tolist(), np.split(order, first[1:]), strict=True)) if len(order) else {}


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


def _result(
    fit: Fit, kind: HeldOutKind, rows: BoolArray, residual: FloatArray, unit: IntArray, doubt: FloatArray
) -> HeldOut:
    """Errors of the chosen rows (n,), of which coefficients that are not known any better leave such doubt (n,)."""
    effort, weight = fit.dataset.effort[rows], weights_of(fit, rows, residual) / np.sqrt(1.0 + doubt)
    return HeldOut(kind, rows, residual, effort, unit, relative_error(residual, effort), rms(residual), weight)
