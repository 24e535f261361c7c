"""Where a model is wrong, with its answers: cells of speed and load."""

from bench.store import Store
from bench.study.errors import lab_errors
from bench.study.material import load_model
from bench.study.models.plots import Axis, ErrorMap
from compensator.lab.comparison import error_map as lab
from compensator.lab.rows.drivers import DRIVERS


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
