"""The ladder: error falling from model to model, down towards the repeatability floor."""

from typing import Any

from bench.store import Store
from bench.store.records import ModelRow
from bench.study.errors import StudyError
from bench.study.material import load


def ladder(store: Store, study_id: int) -> dict[str, Any]:
    """Every model of the study with its training and held-out error (relative, 0..1).

    Raises:
        StudyError: the study has no model.
    """
    material = load(store, study_id)
    models = store.models(study_id)
    if not models:
        raise StudyError(f"study {study_id} has no model; create it again")
    by_id = {model.id: model for model in models}
    return {
        "study_id": study_id,
        "effort": material.effort,
        "floor": models[-1].result["floor"],
        "rungs": [_rung(model, by_id.get(model.parent_id or 0)) for model in models],
    }


def _rung(model: ModelRow, parent: ModelRow | None) -> dict[str, Any]:
    before = set(parent.effects) if parent else set(model.effects)
    added, removed = set(model.effects) - before, before - set(model.effects)
    return {
        "model_id": model.id,
        "parent_id": model.parent_id,
        "effects": model.effects,
        "added": next(iter(added), None),
        "removed": next(iter(removed), None),
        **{key: model.result[key] for key in ("training", "held_out", "held_out_low", "held_out_high")},
        "held_out_kind": model.result["held_out_kind"],
        "breakaway": model.result.get("breakaway"),
        "trials": model.result.get("trials"),
        "motion": _motion(model.result.get("closed_loop")),
        "reflected_error_g": model.result.get("bench", {}).get("reflected_error_g"),
    }


def _motion(kept: dict[str, Any] | None) -> dict[str, Any] | None:
    """Error of the position in closed loop: held out, or of the training trials where there are too few."""
    if kept is None:
        return None
    error = kept["held_out"] or kept["training"]
    return {
        "position": error["position"],
        "position_relative": error["position_relative"],
        "effort_relative": error["effort_relative"],
        "unit": kept["position_unit"],
    }
