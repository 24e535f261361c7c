"""Fit a model (a list of effects) to the rows of a study: bounded least squares, shapes by variable projection."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from compensator.lab.effects.catalogue import effect_named
from compensator.lab.effects.effect import Effect, Motion, Parameter, Shape
from compensator.lab.errors import UnusableDataError
from compensator.lab.model.fitted import Fit, bounds_of, trained_trials, with_terms
from compensator.lab.model.linear import Solution, Term, solve
from compensator.lab.model.prediction import with_own_prediction
from compensator.lab.model.shape_search import find_shapes, first_shapes
from compensator.lab.model.weights import regime_weights
from compensator.lab.recordings.recording import BoolArray, FloatArray
from compensator.lab.recordings.regimes import Regime
from compensator.lab.rows.dataset import Dataset, RowChoice

MOST_PASSES = 20  # each shrinks the change of the predicted load several times
MOST_SEARCHES = 5  # of shapes, where what they explain changes the load that they are of, or where the joint is
SETTLED_SHAPE = 0.01  # of its values, by which a search ends where another one did
SETTLED_SHARE = 1e-5  # of the prediction, that may be left to go: a fiftieth of the least that is worth a name


def fit_model(
    dataset: Dataset,
    effects: Sequence[str],
    training: BoolArray | None = None,
    shapes: Mapping[str, Shape] | None = None,
    sliding: Fit | None = None,
    start: Mapping[str, Shape] | None = None,
) -> Fit:
    """Fit the named effects, every coefficient within its physical bounds.

    Args:
        dataset: rows of all trials.
        effects: names, in order; of columns that the data cannot tell apart, the later is dropped.
        training: rows to fit to, shape (N,); all counted rows if None.
        shapes: nonlinear shapes to keep as they are; those not given are searched.
        sliding: what `fit_sliding` gives for these arguments, where it is known.
        start: shapes of a model like this one, from which the search goes where the rows hold a prediction.

    Raises:
        UnusableDataError: no effects, or fewer rows than columns.
        UnknownEffectError, NotApplicableError: see `catalogue` and `Dataset.columns`.
    """
    if not effects:
        raise UnusableDataError("the model has no effects; add at least one, for instance 'coulomb'")
    rows = dataset.counted if training is None else training
    chosen = [effect_named(name) for name in effects]
    if not (rows & (dataset.regime != Regime.SLIDING)).any() or dataset.rows != "sliding":
        return _fit(dataset, chosen, rows, shapes or {}, np.ones(len(rows)), start or {})
    # rows near reversals were asked for by an effect that lives there: they must not outvote the others
    first = sliding or fit_sliding(dataset, effects, rows, shapes, start)
    kept = {**{name: first.shapes[name] for name in first.names}, **(shapes or {})}
    return _fit(dataset, chosen, rows, kept, regime_weights(dataset, first.residual, rows), start or {})


def fit_sliding(
    dataset: Dataset,
    effects: Sequence[str],
    training: BoolArray,
    shapes: Mapping[str, Shape] | None = None,
    start: Mapping[str, Shape] | None = None,
) -> Fit:
    """Those of the effects that steady sliding shows, fitted to the rows of it. Arguments as `fit_model`."""
    chosen = [effect_named(name) for name in effects]
    steady = [effect for effect in chosen if effect.rows == "sliding"] or chosen
    rows = training & (dataset.regime == Regime.SLIDING)
    return _fit(dataset, steady, rows, shapes or {}, np.ones(len(rows)), start or {})


def widened(fit: Fit, rows: RowChoice) -> Fit:
    """The same model on another choice of rows of the same trials, as `seen_by` it, its shapes kept."""
    dataset = fit.dataset.seen_by(rows)
    chosen = dataset.in_regimes(rows) & np.isin(dataset.trial_index, trained_trials(dataset, fit.training))
    if dataset is fit.dataset and (chosen == fit.training).all():
        return fit
    return fit_model(dataset, fit.names, chosen, fit.shapes)


def seeing_all(fit: Fit) -> Fit:
    """The model refitted to the same rows, whose filter sees stops and reversals beside them; its shapes are kept."""
    dataset = fit.dataset.seen_by("moving")
    return fit if dataset is fit.dataset else fit_model(dataset, fit.names, fit.training, fit.shapes)


def fit_effects(fit: Fit, effects: Sequence[str], sliding: Fit | None = None) -> Fit:
    """Fit other effects to the trials of a fit: to the study's rows, wider where an effect needs it.

    All shapes are found anew, from those of the fit on. `effects`, `sliding` and errors as `fit_model`.
    """
    dataset = fit.dataset
    rows = dataset.in_regimes(dataset.choice_for([effect_named(name) for name in effects]))
    rows = rows & np.isin(dataset.trial_index, trained_trials(dataset, fit.training))
    return fit_model(dataset, effects, rows, sliding=sliding, start=fit.shapes)


def _fit(
    dataset: Dataset,
    effects: Sequence[Effect],
    rows: BoolArray,
    kept: Mapping[str, Shape],
    weight: FloatArray,
    start: Mapping[str, Shape],
) -> Fit:
    misread = any(effect.misreads is not None for effect in effects)
    dataset = (dataset if misread else dataset.as_read()).straightened()
    plain = [effect for effect in effects if not effect.uses_prediction]
    shapes = {**first_shapes(dataset, effects), **start, **kept}
    if len(plain) == len(effects) or not dataset.is_predicted:
        found = find_shapes(dataset, plain or effects, rows, kept, weight, start)
        fit = fit_linear(dataset, plain or effects, rows, found, weight)
        if len(plain) == len(effects):
            return fit
        fit = _settle(fit, effects, {**shapes, **found}, weight)
    else:
        # the prediction of a model that is nearly this one is a better start than none
        fit = _settle(fit_linear(dataset, effects, rows, shapes, weight), effects, shapes, weight)
        if all(effect.name in kept for effect in effects if effect.shape_names):
            return fit
    for number in range(MOST_SEARCHES):
        before, own = fit.shapes, with_own_prediction(fit.dataset, fit.terms)
        shapes = find_shapes(own, effects, rows, kept, weight * own.steadiness, before, known=number > 0)
        if shapes == before and not misread:
            break
        fit = _settle(fit, effects, shapes, weight)
        again = (effect for effect in effects if effect.misreads is not None or effect.builds_on is not None)
        if all(np.allclose(shapes.get(one.name, ()), before.get(one.name, ()), SETTLED_SHAPE, 0.0) for one in again):
            break  # else shapes were found where the joint is not, or beside a load that it has not
    return fit


def _settle(fit: Fit, effects: Sequence[Effect], shapes: Mapping[str, Shape], weight: FloatArray) -> Fit:
    """Refit until the load that the model predicts is the load that its own terms are built from.

    Teeth that meet a little sooner or later leave a rest that does not shrink any more: there, too, it ends.
    """
    misread = any(effect.misreads is not None for effect in effects)  # a position need not be found more exactly
    last, given, before, earlier = np.inf, fit, fit.predicted, None
    for _ in range(MOST_PASSES):
        fit = fit_linear(with_own_prediction(given.dataset, given.terms), effects, fit.training, shapes, weight)
        step = fit.predicted - before
        change = float(np.linalg.norm(step))
        # each step is about as much smaller than the one before, so the last two say how far it is still to go
        rate = min(change / last, 0.5)
        to_go = change if earlier is None else change * rate / (1.0 - rate)
        if to_go <= SETTLED_SHARE * float(np.linalg.norm(before)) or (change >= last and earlier is None):
            break
        given, before = fit, fit.predicted
        if earlier is not None and change < last and not misread:
            given, before = _ahead(fit, step, *earlier)
        earlier = (fit, step) if change < last else None
        last = change
    return fit


def _ahead(fit: Fit, step: FloatArray, earlier: Fit, earlier_step: FloatArray) -> tuple[Fit, FloatArray]:
    """Where two passes lead, by the secant of their steps (Anderson 1965), and what the model predicts there."""
    turn = step - earlier_step
    share = float(step @ turn) / max(float(turn @ turn), np.finfo(float).tiny)
    ahead = with_terms(fit, fit.coefficients - share * (fit.coefficients - earlier.coefficients))
    return ahead, fit.predicted - share * (fit.predicted - earlier.predicted)


def fit_linear(
    dataset: Dataset, effects: Sequence[Effect], rows: BoolArray, shapes: Mapping[str, Shape], weight: FloatArray
) -> Fit:
    """Fit the coefficients of effects of given shapes to the given rows, weighted (N,), and by their steadiness."""
    weight = weight * dataset.steadiness
    columns = dataset.columns_of_model(effects, shapes)
    if int(rows.sum()) < 2 * columns.shape[1]:
        raise UnusableDataError(
            f"{int(rows.sum())} training rows for {columns.shape[1]} coefficients; record longer or more trials"
        )
    inside = weight[rows]
    solution = solve(inside[:, None] * columns[rows], inside * dataset.target[rows], bounds_of(effects, dataset))
    return Fit(dataset, rows, _terms(effects, shapes, solution), columns, weight, dataset.target)


def _terms(effects: Sequence[Effect], shapes: Mapping[str, Shape], solution: Solution) -> tuple[Term, ...]:
    """Share a solution out among the effects."""
    ends = np.cumsum([0, *(len(effect.parameters) for effect in effects)])
    return tuple(
        Term(
            effect,
            shapes.get(effect.name, ()),
            solution.coefficients[a:b],
            solution.kept[a:b],
            solution.at_bound[a:b],
        )
        for effect, (a, b) in zip(effects, pairwise(ends), strict=True)
    )


def with_coefficients(fit: Fit, coefficients: FloatArray) -> Fit:
    """The fit with other coefficients (K,), and what the model then predicts."""
    changed = with_terms(fit, coefficients)
    dataset = with_own_prediction(changed.dataset, changed.terms)
    columns = dataset.columns_of_model(fit.effects, fit.shapes)
    return replace(changed, dataset=dataset, columns=columns, target=dataset.target)


def over_time(fit: Fit) -> Fit:
    """The same coefficients on rows whose filter sees all: what goes on beside stops and reversals is no jump then."""
    return with_coefficients(replace(fit, dataset=fit.dataset.seen_by("moving")), fit.coefficients)


def with_columns(fit: Fit, name: str, columns: FloatArray) -> Fit:
    """The fit refitted with more columns (N, k) that no formula of the catalogue stands for, as a free curve.

    Args:
        fit: to be extended; its shapes are kept.
        name: of the new term.
        columns: over all rows.
    """
    unit = "{effort}"
    parameters = tuple(Parameter(f"knot {index + 1}", unit) for index in range(columns.shape[1]))
    curve = Effect(name, name, "", "", _no_columns, parameters, "time", "", "", builds_on="effort")  # no part of that
    wide = np.column_stack([fit.columns, columns])
    effects = [*(term.effect for term in fit.terms), curve]
    inside = fit.weight[fit.training]
    target = inside * fit.target[fit.training]
    solution = solve(inside[:, None] * wide[fit.training], target, bounds_of(effects, fit.dataset))
    shapes = {**fit.shapes, name: ()}
    return replace(fit, terms=_terms(effects, shapes, solution), columns=wide)


def _no_columns(motion: Motion, _: Shape) -> FloatArray:
    raise NotImplementedError(f"a free curve knows its columns over rows, not over {len(motion.time_s)} samples")
