"""Keep a fitted model in the store, with the errors it had and the shapes it was fitted at."""

from bench.json_types import Values
from bench.store import Store
from bench.store.records import ModelRow
from bench.study.models.base import ROWS_IN_WORDS, STARTS
from bench.study.models.kept import KeptModel
from bench.study.models.ladder import BreakawayRung, StepGain
from compensator.lab.at_rest.breakaway_comparison import compare_breakaway
from compensator.lab.comparison.comparison import repeatability_floor
from compensator.lab.effects.catalogue import catalogue
from compensator.lab.model.fitted import Fit
from compensator.lab.model.gain import Gain, error_interval
from compensator.lab.model.held_out_error import HeldOut, relative_error
from compensator.lab.model.validation import held_out


def keep_model(store: Store, study_id: int, parent_id: int | None, fit: Fit) -> int:
    """Add a fitted model to its study. Returns its id."""
    return store.add_model(study_id, parent_id, list(fit.names), judged(fit))


def judged(fit: Fit) -> Values:
    """What the store is given of a fitted model."""
    return stored(result_of(fit, held_out(fit)))


def kept_of(model: ModelRow) -> KeptModel:
    """What the store has of a model, less shapes of an earlier version, in which their effect had fewer values."""
    kept, known = KeptModel.model_validate(model.result), catalogue()
    count = {name: len(known[name].shape_names) for name in kept.shapes if name in known}
    shapes = {name: shape for name, shape in kept.shapes.items() if count.get(name, len(shape)) == len(shape)}
    return kept if shapes == kept.shapes else kept.model_copy(update={"shapes": shapes})


def stored(kept: KeptModel) -> Values:
    """The same for the store: what was never found is left out."""
    return kept.model_dump(exclude_unset=True)


def breakaway_result(fit: Fit) -> BreakawayRung | None:
    """Relative errors (0..1) of the effort of breaking away; None where the trials hold too few starts from rest."""
    found = compare_breakaway(fit)
    if found is None:
        return None
    low, high = error_interval(found.held_out)
    return BreakawayRung(
        starts=found.starts,
        training=found.relative,
        held_out=found.held_out.relative,
        held_out_low=low,
        held_out_high=high,
    )


def gain_of(rows: str, before: float, after: float, gain: Gain) -> StepGain:
    """The gain of a change as it is kept.

    Args:
        rows: that it was judged on, a row choice or "breakaway".
        before: relative held-out error of these rows, 0..1.
        after: the same with the change.
        gain: of these rows.
    """
    return StepGain(
        rows=ROWS_IN_WORDS.get(rows, STARTS),
        held_out_before=before,
        held_out_after=after,
        gain=gain.value,
        gain_low=gain.low,
        gain_high=gain.high,
    )


def result_of(fit: Fit, outside: HeldOut) -> KeptModel:
    """What is kept of a fit."""
    low, high = error_interval(outside)
    floor = repeatability_floor(fit)
    rows = fit.training & fit.dataset.counted
    return KeptModel(
        training=relative_error(fit.residual[rows], fit.dataset.effort[rows]),
        held_out=outside.relative,
        held_out_low=low,
        held_out_high=high,
        held_out_kind=outside.kind,
        trials=len(fit.dataset.trials),
        floor=None if floor is None else floor.relative,
        breakaway=breakaway_result(fit),
        shapes={name: tuple(shape) for name, shape in fit.shapes.items()},
        coefficients={term.effect.name: term.coefficients.tolist() for term in fit.terms},
    )
