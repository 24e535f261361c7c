"""What the routes of /studies answer with. Errors are shares (0..1) where the name says `relative`; all else is SI."""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel, Field

from bench.service.http.pages import Page
from compensator.lab.chance import LEAST_STATED

Numbers = list[float | None]
Condition = float | str | bool
Role = Literal["training", "held_out"]
LEAST_P = f"{LEAST_STATED:g} stands for that and less: no smaller chance can be known"


class EffortName(BaseModel):
    """The quantity that the models explain."""

    name: str = Field(examples=["torque"])
    unit: str = Field(examples=["N m"])


class StudyTrial(BaseModel):
    """One trial of a study and what it is used for."""

    trial_id: int
    name: str
    role: Role
    conditions: dict[str, Condition]


class Study(BaseModel):
    """A study: its trials, and the model that it stands at."""

    study_id: int
    name: str
    trials: list[StudyTrial]
    effort: EffortName
    cutoff_hz: float = Field(description="low-pass to which effort and motion are filtered alike [Hz]")
    rows: str = Field(description="which rows count: sliding, moving or all")
    model_id: int = Field(description="the base model at creation, the newest model later")


class StudyName(BaseModel):
    """One line of the list of studies."""

    study_id: int
    name: str
    created_utc: datetime


class Studies(Page):
    """One page of studies, newest first."""

    items: list[StudyName]


class Error(BaseModel):
    """Error of a model."""

    rms: float | None = Field(description="root mean square, in the unit of the effort")
    relative: float | None = Field(description="rms over the rms of the measured effort, 0..1")
    kind: str | None = Field(default=None, description="how it was held out", examples=["leave-one-trial-out"])


class Errors(BaseModel):
    """Error on the trials of the fit, on the others, and the floor that repeats set."""

    training: Error
    held_out: Error | None
    floor: Error | None = Field(description="what repeated trials differ by; null without repeats")


class FittedParameter(BaseModel):
    """One parameter of the fit with its 95 % interval."""

    effect: str
    name: str
    value: float | None
    unit: str
    low: float | None
    high: float | None
    note: str = Field(description="what is wrong with it, if anything: on a bound, not determined")


class TrialError(StudyTrial):
    """Error on one trial."""

    rms: float | None
    relative: float | None


class RegimeError(BaseModel):
    """Error in one regime of motion; of "stuck", by what efforts lie beyond those that friction holds."""

    name: str
    rows: int
    rms: float | None
    relative: float | None


class Series(BaseModel):
    """Measured and predicted effort of one trial over time; all lists have the same length."""

    trial_id: int
    name: str
    time_s: Numbers
    measured: Numbers
    predicted: Numbers
    residual: Numbers


class DriverGroup(BaseModel):
    """Residual in bins of a driving variable, for one direction of motion."""

    direction: Literal["forward", "backward", "both"]
    x: Numbers
    mean: Numbers
    low: Numbers
    high: Numbers
    count: list[int]


class ResidualAgainst(BaseModel):
    """Residual against one driving variable."""

    driver: str
    unit: str
    groups: list[DriverGroup]


class BreakawayError(BaseModel):
    """The same model, held against the effort of breaking away from rest."""

    starts: int = Field(description="starts from rest whose effort is known")
    training: Error
    held_out: Error
    parameters: list[FittedParameter] = Field(description="of the breakaway effort: not those of sliding")


class BeyondFriction(BaseModel):
    """What lies beyond one end of the span in which friction holds the joint."""

    side: Literal["above", "below"]
    outside: float | None = Field(description="share of the stretches, 0..1")
    largest: float | None = Field(description="violation, in the unit of the effort")
    p_value: float | None = Field(description=f"chance of one as sure in any stretch; {LEAST_P}")
    trial: str = Field(description="of the surest one")
    time_s: float | None = Field(description="of the surest one, since the start of the trial")


class AtRest(BaseModel):
    """The same model, held against the joint at rest: friction holds it between two efforts, and no others."""

    stretches: int = Field(description="of 0.1 s")
    rests: int
    outside: float | None = Field(description="share of the stretches beyond either end, 0..1")
    largest: float | None = Field(description="violation, in the unit of the effort")
    sides: list[BeyondFriction]
    static_friction_from: Literal["starts", "sliding"]
    sentence: str


class Comparison(BaseModel):
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
    notes: list[str]


class EffectClass(BaseModel):
    """Effects that these data cannot tell apart."""

    effects: list[str]
    sentence: str
    separating_trial: str | None = Field(description="the trial that would tell them apart")


class Picture(BaseModel):
    """Why: the residual against the effect's driving variable, and the effect's curve over it."""

    driver: str
    unit: str
    against_motion: bool = Field(description="True where the residual is counted positive against the motion")
    x: Numbers
    residual: Numbers
    low: Numbers
    high: Numbers
    curve_x: Numbers
    curve: Numbers


class Ranked(BaseModel):
    """One effect of the ranking. Held-out errors are relative (0..1); gain = 1 - after / before."""

    effect: str
    title: str
    score: float | None
    p_value: float | None = Field(description=f"of this effect alone; {LEAST_P}")
    held_out_before: float | None
    held_out_after: float | None
    gain: float | None
    gain_low: float | None
    gain_high: float | None
    in_class: bool = Field(description="one of the effects that the data name")
    confused_with: list[str]
    d_prime: float | None = Field(
        description="how well it stands apart from its best rival; from 6 on the name is sure"
    )
    physical: bool = Field(description="False where the fitted sign or size is physically impossible")
    sentence: str
    picture: Picture | None


class ProvisionalTerm(BaseModel):
    """A curve over the variable that something unknown varies with; held-out errors are relative (0..1)."""

    effect: str = Field(description="to be added like any effect", examples=["curve_of_temperature_against_motion"])
    title: str
    held_out_before: float | None
    held_out_after: float | None
    gain: float | None
    gain_low: float | None
    gain_high: float | None
    sentence: str
    picture: Picture | None


class Diagnosis(BaseModel):
    """Is anything missing, what is it called, and does it help?"""

    study_id: int
    model_id: int
    verdict: Literal["missing", "nothing", "unknown-effect", "data-problem"]
    sentence: str
    p_value: float | None = Field(
        description=f"chance of such evidence in any of a diagnosis's screenings if nothing were missing; {LEAST_P}"
    )
    notes: list[str]
    data_problems: list[str]
    classes: list[EffectClass]
    ranking: list[Ranked]
    provisional: ProvisionalTerm | None = Field(description="null unless the verdict is unknown-effect")


class BeforeAfter(BaseModel):
    """Relative errors (0..1) of one model."""

    training: float | None
    held_out: float | None


class BreakawayChange(BaseModel):
    """What a change did to the error of the breakaway effort, held out; relative (0..1)."""

    held_out_before: float | None
    held_out_after: float | None
    gain: float | None
    gain_low: float | None
    gain_high: float | None


class Changed(BaseModel):
    """The child model and what the change did to the error."""

    model_id: int
    parent_id: int
    effects: list[str]
    before: BeforeAfter
    after: BeforeAfter
    gain: float | None
    gain_low: float | None
    gain_high: float | None
    breakaway: BreakawayChange | None = Field(description="null: no effect of breakaway, or too few starts from rest")
    sentence: str


class SearchStep(BaseModel):
    """One change that a search made; errors are relative (0..1)."""

    model_id: int
    change: Literal["add", "swap", "drop"]
    effect: str
    instead_of: str | None
    before: float | None
    after: float | None
    sentence: str


class Searched(BaseModel):
    """The way of a search, and what is still missing at its end."""

    study_id: int
    model_id: int
    added: list[str]
    steps: list[SearchStep]
    verdict: str
    sentence: str


class BreakawayRung(BaseModel):
    """Error of one model on the effort of breaking away, relative (0..1)."""

    starts: int
    training: float | None
    held_out: float | None
    held_out_low: float | None
    held_out_high: float | None


class RungMotion(BaseModel):
    """Error of one model in closed loop: held out, or of the training trials where there are too few."""

    position: float | None = Field(description="root mean square, in `unit`")
    position_relative: float | None = Field(description="over the standard deviation of the measured position, 0..1")
    effort_relative: float | None = Field(description="of the effort, relative (0..1)")
    unit: Literal["rad", "m"]


class Rung(BaseModel):
    """One model of the ladder; errors are relative (0..1)."""

    model_id: int
    parent_id: int | None
    effects: list[str]
    added: str | list[str] | None
    removed: str | list[str] | None
    training: float | None
    held_out: float | None
    held_out_low: float | None
    held_out_high: float | None
    held_out_kind: str = Field(description="hold-out, leave-one-trial-out or leave-one-block-out")
    reflected_error_g: float | None = Field(
        description="error of the reflected load in motion with the model at work on the bench, rms; null: not tried"
    )
    breakaway: BreakawayRung | None = Field(description="null: too few starts from rest, or a model of older versions")
    motion: RungMotion | None = Field(description="null: not simulated in closed loop yet")
    trials: int | None = Field(description="of the study when the model was fitted; null: in models of older versions")


class Ladder(BaseModel):
    """The error from model to model, down towards the floor."""

    study_id: int
    effort: EffortName
    floor: float | Error | None
    rungs: list[Rung]
