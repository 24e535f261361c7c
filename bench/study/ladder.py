"""The ladder: error falling from model to model, down towards the repeatability floor."""

from collections.abc import Collection
from math import isnan

from bench.store import Store
from bench.store.records import ModelRow
from bench.study.errors import StudyError
from bench.study.keep import kept_of
from bench.study.material import load
from bench.study.models.base import NEAR_REVERSALS, ROWS_IN_WORDS, STARTS
from bench.study.models.kept import KeptModel, KeptMotion
from bench.study.models.ladder import Ladder, Rung, RungMotion
from bench.study.models.stages import LOADED
from compensator.lab import progress
from compensator.lab.effects.catalogue import effect_named
from compensator.lab.rows.dataset import Dataset


@progress.stages(LOADED)
def ladder(store: Store, study_id: int) -> Ladder:
    """Every model of the study with its training and held-out error (relative, 0..1).

    Raises:
        StudyError: the study has no model.
    """
    material = load(store, study_id)
    models = store.models(study_id)
    if not models:
        raise StudyError(f"study {study_id} has no model; create it again")
    by_id = {model.id: model for model in models}
    newest = kept_of(models[-1])
    # a model that lacks much takes some of that for the scatter of repeats
    alike = [kept for kept in map(kept_of, models) if kept.trials == newest.trials]
    return Ladder(
        study_id=study_id,
        effort=material.effort,
        floor=min(alike, key=lambda kept: (isnan(kept.held_out), kept.held_out)).floor,
        rows=ROWS_IN_WORDS[material.dataset.rows],
        rungs=[_rung(model, by_id.get(model.parent_id or 0), material.dataset) for model in models],
    )


def _rung(model: ModelRow, parent: ModelRow | None, dataset: Dataset) -> Rung:
    before = set(parent.effects) if parent else set(model.effects)
    added, removed = set(model.effects) - before, before - set(model.effects)
    kept = kept_of(model)
    return Rung(
        model_id=model.id,
        parent_id=model.parent_id,
        effects=model.effects,
        added=next(iter(added), None),
        removed=next(iter(removed), None),
        training=kept.training,
        held_out=kept.held_out,
        held_out_low=kept.held_out_low,
        held_out_high=kept.held_out_high,
        held_out_kind=kept.held_out_kind,
        breakaway=kept.breakaway,
        trials=kept.trials,
        motion=None if kept.closed_loop is None else _motion(kept.closed_loop),
        reflected_error_g=None if kept.bench is None else kept.bench.reflected_error_g,
        gain=kept.gain,
        shows=_shows(kept, added or removed, dataset),
    )


def _shows(kept: KeptModel, changed: Collection[str], dataset: Dataset) -> str:
    """Where a change of these effects shows, though the study's rows do not hold that; empty where they do."""
    if kept.gain is not None and kept.gain.rows == STARTS:
        return STARTS
    if not changed or dataset.choice_for([effect_named(name) for name in changed]) == dataset.rows:
        return ""
    return NEAR_REVERSALS


def _motion(kept: KeptMotion) -> RungMotion:
    """Error of the position in closed loop: held out, or of the training trials where there are too few."""
    error = kept.held_out or kept.training
    return RungMotion(
        position=error.position,
        position_relative=error.position_relative,
        effort_relative=error.effort_relative,
        unit=kept.position_unit,
    )
