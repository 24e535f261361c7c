"""Measured against predicted. Errors are shares (0..1) where the name says `relative`; all else is SI."""

from typing import Literal

from pydantic import Field

from bench.json_types import Number, Numbers
from bench.study.models.base import LEAST_P, EffortName, StudyModel
from bench.study.models.diagnosis import Finding
from bench.study.models.study import StudyTrial


class Error(StudyModel):
    """Error of a model."""

    rms: Number = Field(description="root mean square, in the unit of the effort")
    relative: Number = Field(description="rms over the rms of the measured effort, 0..1")
    kind: str | None = Field(default=None, description="how it was held out", examples=["leave-one-trial-out"])


class Errors(StudyModel):
    """Error on the trials of the fit, on the others, and the floor that repeats set."""

    training: Error
    held_out: Error
    floor: Error | None = Field(description="what repeated trials differ by; null without repeats")


class FittedParameter(StudyModel):
    """One parameter of the fit with its 95 % interval."""

    effect: str
    name: str
    value: Number
    unit: str
    low: Number
    high: Number
    note: str = Field(description="what is wrong with it, if anything: on a bound, not determined")


class TrialError(StudyTrial):
    """Error on one trial."""

    rms: Number
    relative: Number


class RegimeError(StudyModel):
    """Error in one regime of motion; of "stuck", by what efforts lie beyond those that friction holds."""

    name: str
    rows: int
    rms: Number
    relative: Number


class Series(StudyModel):
    """Measured and predicted effort of one trial over time: lists of one length; null where no row is used."""

    trial_id: int
    name: str
    time_s: Numbers
    measured: Numbers
    predicted: Numbers
    residual: Numbers


class DriverGroup(StudyModel):
    """Residual in bins of a driving variable, for one direction of motion."""

    direction: Literal["forward", "backward", "both"]
    x: Numbers
    mean: Numbers
    low: Numbers
    high: Numbers
    count: list[int]


class ResidualAgainst(StudyModel):
    """Residual against one driving variable."""

    driver: str
    unit: str
    groups: list[DriverGroup]


class BreakawayError(StudyModel):
    """The same model, held against the effort of breaking away from rest."""

    starts: int = Field(description="starts from rest whose effort is known")
    training: Error
    held_out: Error
    parameters: list[FittedParameter] = Field(description="of the breakaway effort: not those of sliding")


class BeyondFriction(StudyModel):
    """What lies beyond one end of the span in which friction holds the joint."""

    side: Literal["above", "below"]
    outside: Number = Field(description="share of the stretches, 0..1")
    largest: Number = Field(description="violation, in the unit of the effort")
    p_value: Number = Field(description=f"chance of one as sure in any stretch; {LEAST_P}")
    trial: str = Field(description="of the surest one")
    time_s: Number = Field(description="of the surest one, since the start of the trial")


class AtRest(StudyModel):
    """The same model, held against the joint at rest: friction holds it between two efforts, and no others."""

    stretches: int = Field(description="of 0.1 s")
    rests: int
    outside: Number = Field(description="share of the stretches beyond either end, 0..1")
    largest: Number = Field(description="violation, in the unit of the effort")
    sides: list[BeyondFriction]
    static_friction_from: Literal["starts", "sliding"]
    sentence: str


class Comparison(StudyModel):
    """Measured against predicted, and where they differ."""

    study_id: int
    model_id: int
    effects: list[str]
    parameters: list[FittedParameter]
    effort: EffortName
    error: Errors
    trials: list[TrialError]
    regimes: list[RegimeError]
    at_rest: AtRest | None = Field(description="null: next to no rest in these trials")
    breakaway: BreakawayError | None = Field(description="null: too few starts from rest in these trials")
    series: list[Series]
    residual_against: list[ResidualAgainst]
    notes: list[str] = Field(description="sentences; `findings` has some with their codes")
    findings: list[Finding] = Field(description="what holds for any answer on these trials: too few, or recorded once")
