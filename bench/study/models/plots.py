"""What the plots of a study show over time, where a model is wrong, and the moments behind it."""

from pydantic import Field

from bench.json_types import Number, Numbers
from bench.study.models.base import EffortName, StudyModel
from bench.study.models.comparison import Series


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


class GainedMoment(Moment):
    """A moment in which a model with one effect more is closer."""

    rms_with: Number = Field(description="of the residual with the effect, in the unit of the effort")
    share: float = Field(description="of all that the effect takes away of the squared residual, 0..1")


class Action(StudyModel):
    """Where an effect acts that a model does not have, and what it would take away."""

    study_id: int
    model_id: int
    effect: str
    title: str
    effort: EffortName
    items: list[GainedMoment] = Field(description="the largest share first; none where it changes no prediction")
    series: list[Series] = Field(description="of every trial, predicted with the effect")
