"""Where a model is wrong, with its answers: cells of speed and load, and the moments behind one."""

import math
from collections.abc import Sequence

from pydantic import Field

from bench.json_types import Number, Numbers
from bench.store import Store
from bench.study.errors import StudyError, lab_errors
from bench.study.material import load_model
from bench.study.models.base import EffortName, StudyModel
from compensator.lab.comparison import error_map as lab
from compensator.lab.rows.drivers import DRIVERS


class Axis(StudyModel):
    """One side of the map."""

    driver: str = Field(description="to be used in `where` of /moments", examples=["velocity"])
    title: str
    unit: str


class ErrorMap(StudyModel):
    """Error in cells; the first index counts along `down`, the second along `across`. Null: too few rows."""

    study_id: int
    model_id: int
    effort: EffortName
    across: Axis
    down: Axis
    across_edges: list[float]
    down_edges: list[float]
    rms: list[Numbers] = Field(description="of the residual, in the unit of the effort")
    mean: list[Numbers] = Field(description="of the residual, in the unit of the effort")
    count: list[list[int]]


class Moment(StudyModel):
    """A stretch of one trial during which every criterion held, but for pauses."""

    trial_id: int
    name: str
    from_s: float = Field(description="since the start of the trial")
    to_s: float
    rows: int
    rms: Number
    mean: Number


class Moments(StudyModel):
    """The moments with most error first."""

    study_id: int
    model_id: int
    effort: EffortName
    items: list[Moment]


def error_map(store: Store, study_id: int, model_id: int | None = None) -> ErrorMap:
    """Error of a model over speed and load.

    Raises:
        StudyError: no such model, or the trials hold one speed or one load only.
    """
    material, model = load_model(store, study_id, model_id)
    with lab_errors():
        found = lab.error_map(material.fit_of(model))
    unit = material.dataset.effort_definition.unit
    facts = material.definition.facts

    def axis(name: str) -> Axis:
        return Axis(driver=name, title=DRIVERS[name].title, unit=DRIVERS[name].unit_in(unit, facts))

    return ErrorMap(
        study_id=study_id,
        model_id=model.id,
        effort=material.effort,
        across=axis(found.across),
        down=axis(found.down),
        across_edges=found.across_edges.tolist(),
        down_edges=found.down_edges.tolist(),
        rms=found.rms.tolist(),
        mean=found.mean.tolist(),
        count=found.count.astype(int).tolist(),
    )


def moments(store: Store, study_id: int, where: Sequence[str], model_id: int | None = None) -> Moments:
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
    items = [
        Moment(
            trial_id=material.trials[one.trial].id,
            name=material.trials[one.trial].name,
            from_s=one.from_s,
            to_s=one.to_s,
            rows=one.rows,
            rms=one.rms,
            mean=one.mean,
        )
        for one in found
    ]
    return Moments(study_id=study_id, model_id=model.id, effort=material.effort, items=items)


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
