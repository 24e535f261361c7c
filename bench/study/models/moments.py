"""Moments of a study: when the joint was somewhere, or where an effect that the model lacks would act."""

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import EffortName, StudyModel
from bench.study.models.comparison import Series


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
