"""Where a model is wrong, as JSON: cells of speed and load, and the moments behind one."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from bench.store import Store
from bench.study.errors import StudyError, lab_errors
from bench.study.material import load_model
from compensator.lab.comparison import error_map as lab
from compensator.lab.rows.drivers import DRIVERS


def error_map(store: Store, study_id: int, model_id: int | None = None) -> dict[str, Any]:
    """Error of a model over speed and load.

    Raises:
        StudyError: no such model, or the trials hold one speed or one load only.
    """
    material, model = load_model(store, study_id, model_id)
    with lab_errors():
        found = lab.error_map(material.fit_of(model))
    unit = material.dataset.effort_definition.unit
    facts = material.definition.facts
    axes = {
        side: {"driver": name, "title": DRIVERS[name].title, "unit": DRIVERS[name].unit_in(unit, facts)}
        for side, name in (("across", found.across), ("down", found.down))
    }
    edges = {"across_edges": found.across_edges.tolist(), "down_edges": found.down_edges.tolist()}
    cells = {"rms": found.rms.tolist(), "mean": found.mean.tolist(), "count": found.count.astype(int).tolist()}
    return {"study_id": study_id, "model_id": model.id, "effort": material.effort, **axes, **edges, **cells}


def moments(store: Store, study_id: int, where: Sequence[str], model_id: int | None = None) -> dict[str, Any]:
    """When the joint was somewhere, and how wrong the model was then.

    Args:
        store: with the study.
        study_id: which study.
        where: criteria `driver=low..high`, such as `velocity=0.5..1`.
        model_id: which model; None takes the newest.

    Raises:
        StudyError: no such model, a criterion that is none, or a driver that these trials do not have.
    """
    criteria = dict(_parse(text) for text in where)
    material, model = load_model(store, study_id, model_id)
    with lab_errors():
        found = lab.moments(material.fit_of(model), criteria)
    items = []
    for one in found:
        values = asdict(one)
        trial = material.trials[values.pop("trial")]
        items.append({"trial_id": trial.id, "name": trial.name, **values})
    return {"study_id": study_id, "model_id": model.id, "effort": material.effort, "items": items}


def _parse(text: str) -> tuple[str, tuple[float, float]]:
    name, _, ends = text.partition("=")
    low, dots, high = ends.partition("..")
    try:
        found = float(low), float(high)
    except ValueError:
        found = math.nan, math.nan
    if not (name and dots and found[0] <= found[1]):
        raise StudyError(f"'{text}' is no criterion; wanted driver=low..high, for instance velocity=0.5..1")
    return name.strip(), found
