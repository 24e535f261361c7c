"""What a change of a model did to its error. Errors are relative (0..1).

Gain is the fall of the held-out error, each row counting by how well it is known.
"""

from typing import Literal

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import StudyModel
from bench.study.models.comparison import FittedParameter
from bench.study.models.diagnosis import Conclusion, Finding


class BeforeAfter(StudyModel):
    """Relative errors (0..1) of one model."""

    training: Number
    held_out: Number


class BreakawayChange(StudyModel):
    """What a change did to the error of the breakaway effort, held out; relative (0..1)."""

    held_out_before: Number
    held_out_after: Number
    gain: Number
    gain_low: Number
    gain_high: Number
    parameters: list[FittedParameter] = Field(
        description="of the added effect in breakaway; empty where it was dropped"
    )


class Changed(StudyModel):
    """The child model and what the change did to the error."""

    model_id: int
    parent_id: int
    effects: list[str]
    before: BeforeAfter
    after: BeforeAfter
    rows: str = Field(
        description="which rows the held-out errors and the gain are of: those where the changed effect lives",
        examples=["near reversals too"],
    )
    ladder_before: Number = Field(description="held-out error of the parent as the ladder has it")
    ladder_after: Number = Field(description="the same of the child")
    ladder_rows: str = Field(
        description="which rows the training errors and those of the ladder are of", examples=["steady sliding"]
    )
    gain: Number
    gain_low: Number
    gain_high: Number
    parameters: list[FittedParameter] = Field(description="of the added effect in sliding; empty where it was dropped")
    breakaway: BreakawayChange | None = Field(description="null: no effect of breakaway, or too few starts from rest")
    sentence: str


class SearchStep(StudyModel):
    """One change that a search made; errors are relative (0..1)."""

    model_id: int
    change: Literal["add", "swap", "drop"]
    effect: str
    instead_of: str | None
    before: Number
    after: Number
    rivals: list[str] = Field(description="of an effect that was added: what these trials cannot tell it from")
    sentence: str


class Searched(StudyModel):
    """The way of a search, and what is still missing at its end."""

    study_id: int
    model_id: int
    added: list[str]
    steps: list[SearchStep]
    verdict: str
    conclusion: Conclusion = Field(description="of the last model, as its diagnosis has it")
    offered: str | None = Field(
        description="effect, or curve in its place, that its last model's diagnosis offers to be added; null: none"
    )
    slight: bool = Field(description="what its last model lacks by the verdict is slight, and was not added")
    sentence: str
    findings: list[Finding] = Field(description="what holds for any answer on these trials: too few, or recorded once")
