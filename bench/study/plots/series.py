"""What the plots of a study show over time: effort and prediction, and what drives them, at the same rows."""

from dataclasses import dataclass

import numpy as np

from bench.store import Store
from bench.study.errors import StudyError
from bench.study.material import Material, load
from bench.study.models.comparison import Series
from bench.study.models.plots import DriversOverTime, DriverValues
from compensator.lab.model.fit import over_time
from compensator.lab.model.fitted import Fit
from compensator.lab.recordings.recording import FloatArray, IntArray
from compensator.lab.rows.dataset import Dataset
from compensator.lab.rows.drivers import DRIVERS, available

SERIES_POINTS = 600  # of each trial in the answer; the fit uses all rows


def series_of(material: Material, fit: Fit) -> list[Series]:
    """Measured and predicted effort of every trial."""
    series, fit = [], over_time(fit)
    for index, trial in enumerate(material.trials):
        shown = _shown(fit.dataset, index)
        series.append(
            Series(
                trial_id=trial.id,
                name=trial.name,
                time_s=shown.time_s.tolist(),
                measured=shown.of(fit.dataset.effort),
                predicted=shown.of(fit.predicted),
                residual=shown.of(fit.residual),
            )
        )
    return series


def drivers_over_time(store: Store, study_id: int, trial_id: int) -> DriversOverTime:
    """What drives the residual of a trial, over time.

    Raises:
        StudyError: the study has no such trial, or its trials cannot be used.
    """
    material = load(store, study_id)
    ids = [trial.id for trial in material.trials]
    if trial_id not in ids:
        raise StudyError(f"study {study_id} has no trial {trial_id}; its trials are: {', '.join(map(str, ids))}")
    dataset = material.dataset
    shown = _shown(dataset, ids.index(trial_id))
    unit, facts = dataset.effort_definition.unit, material.definition.facts
    return DriversOverTime(
        study_id=study_id,
        trial_id=trial_id,
        time_s=shown.time_s.tolist(),
        drivers=[
            DriverValues(
                driver=name,
                title=DRIVERS[name].title,
                unit=DRIVERS[name].unit_in(unit, facts),
                values=shown.of(values),
            )
            for name, values in available(dataset).items()
        ],
    )


@dataclass(frozen=True)
class _Shown:
    """The rows of a trial that are shown; where rows between two of them are not used, a gap stands."""

    rows: IntArray
    gaps: IntArray  # before which of the rows
    time_s: FloatArray  # since the start of the trial, the middle of a gap for it

    def of(self, values: FloatArray) -> list[float]:
        """Of values of all rows of the dataset those that are shown; NaN in a gap."""
        shown: list[float] = np.insert(values[self.rows].astype(np.float64), self.gaps, np.nan).tolist()
        return shown


def _shown(dataset: Dataset, index: int) -> _Shown:
    trial = dataset.trials[index]
    own = dataset.trial_rows[index]
    rows = np.arange(own.start, own.stop)
    at = np.arange(0, len(rows), max(1, len(rows) // SERIES_POINTS))
    time = dataset.time_of(trial)[at]
    # rows are picked at one step: where a longer one lies between two, nothing was measured, or it was of no use
    steps = np.diff(trial.picked)
    broken = np.concatenate([[0], np.cumsum(steps > (steps.min() if len(steps) else 0))])
    gaps = np.flatnonzero(np.diff(broken[at])) + 1
    return _Shown(rows[at], gaps, np.insert(time, gaps, (time[gaps - 1] + time[gaps]) / 2.0))
