"""What the trials of a study can and cannot tell, before any diagnosis."""

from typing import Literal

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import StudyModel
from bench.study.models.diagnosis import Finding


class Held(StudyModel):
    """What the trials hold of one quantity."""

    quantity: str = Field(examples=["directions"])
    found: str = Field(description="in words", examples=["54 % forward, 46 % backward"])
    lacking: str = Field(description="what that leaves open; empty where nothing", examples=[""])


class JudgedEffect(StudyModel):
    """How the trials stand to one effect that the model does not have."""

    effect: str = Field(examples=["load_friction"])
    title: str
    standing: Literal["judgeable", "confounded", "hidden", "not measured"]
    reason: str = Field(description="what the trials lack, or where the effect hides; empty where nothing")
    rivals: list[str] = Field(description="effects that look alike in these trials")
    smallest: Number = Field(description="size that would show for sure, as a share of the effort (0..1)")


class Advice(StudyModel):
    """A trial that would help, and the effects that it would let be judged."""

    trial: str = Field(examples=["the same motion with two other loads, one of them three times the other"])
    effects: list[str] = Field(description="effects that it opens; empty where it serves all of them")


class Coverage(StudyModel):
    """What trials can and cannot tell."""

    study_id: int
    model_id: int
    held: list[Held]
    effects: list[JudgedEffect]
    advice: list[Advice] = Field(description="the trial that opens most effects first")
    sentence: str
    findings: list[Finding] = Field(description="what holds for any answer on these trials: too few, or recorded once")


class Checked(StudyModel):
    """What trials hold for a model."""

    carries: bool = Field(description="whether they hold enough motion to fit the base model")
    sentence: str
    rows: int = Field(description="in which the joint slides, of the trials that are fitted")
    parameters: int = Field(description="of the base model")
    still: list[str] = Field(description="trials in which the joint does not slide")
    hold_out: str = Field(description="criterion that would judge the model well; empty: there is none")
    advice: str = Field(description="why that one")
