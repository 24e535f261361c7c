"""What the plots of a study show over time: effort and prediction, and what drives them, at the same rows."""

import numpy as np
from pydantic import Field

from bench.json_types import Numbers
from bench.store import Store
from bench.study.errors import StudyError
from bench.study.material import Material, load
from bench.study.models.base import StudyModel
from bench.study.models.comparison import Series
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import FloatArray
from compensator.lab.rows.dataset import Dataset, IntArray
from compensator.lab.rows.drivers import DRIVERS, available

SERIES_POINTS = 600  # of each trial in the answer; the fit uses all rows


class DriverValues(StudyModel):
    """One driving variable over time."""

    driver: str = Field(examples=["velocity"])
    title: str
    unit: str
    values: Numbers


class DriversOverTime(StudyModel):
    """The driving variables of one trial, at the times of its series; all lists have the same length."""

    study_id: int
    trial_id: int
    time_s: Numbers
    drivers: list[DriverValues]


def series_of(material: Material, fit: Fit) -> list[Series]:
    """Measured and predicted effort of every trial."""
    series = []
    for index, trial in enumerate(material.trials):
        chosen, time = _shown(fit.dataset, index)
        series.append(
            Series(
                trial_id=trial.id,
                name=trial.name,
                time_s=time.tolist(),
                measured=fit.dataset.effort[chosen].tolist(),
                predicted=fit.predicted[chosen].tolist(),
                residual=fit.residual[chosen].tolist(),
            )
        )
    return series


def drivers_over_time(store: Store, study_id: int, trial_id: int) -> DriversOverTime:
    """What drives the residual of a trial, over time.

    Args:
        store: with the study.
        study_id: which study.
        trial_id: which of its trials.

    Raises:
        StudyError: the study has no such trial, or its trials cannot be used.
    """
    material = load(store, study_id)
    ids = [trial.id for trial in material.trials]
    if trial_id not in ids:
        raise StudyError(f"study {study_id} has no trial {trial_id}; its trials are: {', '.join(map(str, ids))}")
    dataset = material.dataset
    chosen, time = _shown(dataset, ids.index(trial_id))
    unit, facts = dataset.effort_definition.unit, material.definition.facts
    return DriversOverTime(
        study_id=study_id,
        trial_id=trial_id,
        time_s=time.tolist(),
        drivers=[
            DriverValues(
                driver=name,
                title=DRIVERS[name].title,
                unit=DRIVERS[name].unit_in(unit, facts),
                values=values[chosen].tolist(),
            )
            for name, values in available(dataset).items()
        ],
    )


def _shown(dataset: Dataset, index: int) -> tuple[IntArray, FloatArray]:
    """Rows of a trial that are shown, and their times since its start [s]."""
    rows = np.flatnonzero(dataset.trial_index == index)
    chosen = rows[:: max(1, len(rows) // SERIES_POINTS)]
    time: FloatArray = dataset.time_of(dataset.trials[index])[chosen - rows[0]] if len(rows) else np.empty(0)
    return chosen, time
