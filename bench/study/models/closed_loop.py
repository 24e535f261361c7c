"""A model under the servo that its trials ran under. Relative errors are shares (0..1)."""

from typing import Literal

from pydantic import Field

from bench.json_types import Number, Numbers
from bench.study.models.base import EffortName, Role, StudyModel

PositionUnit = Literal["rad", "m"]


class LoopError(StudyModel):
    """Errors over the samples at which the loop is closed; relative ones are shares (0..1)."""

    samples: int
    position: Number = Field(description="root mean square, in the unit of the position")
    position_relative: Number = Field(description="over the standard deviation of the measured position")
    velocity_relative: Number = Field(description="over the root mean square of the measured speed")
    effort: Number = Field(description="root mean square, in the unit of the effort")
    effort_relative: Number = Field(description="over that of the measured effort")


class Motion(StudyModel):
    """Measured and simulated position over time; all lists have the same length."""

    time_s: Numbers
    measured: Numbers
    simulated: Numbers


class TrialInLoop(LoopError):
    """One trial."""

    trial_id: int
    name: str
    role: Role
    law: Literal["bench", "recording", "stand-in"] = Field(
        description="who tells the servo's gains: the bench that closed the loop, set point and effort of the "
        "recording, or nobody, so that a servo of twice the motion's bandwidth stands in"
    )
    settled: bool = Field(description="False where friction decides, by less than the model knows, where it stops")
    series: Motion


class Coefficient(StudyModel):
    """One coefficient, by least squares along the measured motion and refined along the simulated one."""

    effect: str
    name: str
    unit: str
    before: Number
    after: Number


class Refined(StudyModel):
    """The same with refined coefficients."""

    training: LoopError
    held_out: LoopError | None
    passes: int
    gained: bool = Field(description="False: no coefficients are better in closed loop, and none changed")
    inverse_before: Number = Field(description="relative error of the effort along the measured motion")
    inverse_after: Number
    parameters: list[Coefficient]
    sentence: str


class ClosedLoop(StudyModel):
    """Where a model's joint goes, under the servo that the measured one ran under."""

    study_id: int
    model_id: int
    effects: list[str]
    effort: EffortName
    position_unit: PositionUnit
    training: LoopError
    held_out: LoopError | None = Field(description="null: too few trials to leave one out in turn")
    trials: list[TrialInLoop]
    refined: Refined | None = Field(description="null: not asked for")
    notes: list[str]
