"""The error from model to model."""

from typing import Literal

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import EffortName, StudyModel


class BreakawayRung(StudyModel):
    """Error of one model on the effort of breaking away, relative (0..1)."""

    starts: int
    training: Number
    held_out: Number
    held_out_low: Number
    held_out_high: Number


class RungMotion(StudyModel):
    """Error of one model in closed loop: held out, or of the training trials where there are too few."""

    position: Number = Field(description="root mean square, in `unit`")
    position_relative: Number = Field(description="over the standard deviation of the measured position, 0..1")
    effort_relative: Number = Field(description="of the effort, relative (0..1)")
    unit: Literal["rad", "m"]


class StepGain(StudyModel):
    """What a change of the model did to the held-out error on the rows that it was judged on; relative (0..1).

    Gain is the fall of that error, each row counting by how well it is known, with a 90 % interval.
    """

    rows: str = Field(description="which rows it was judged on", examples=["near reversals too"])
    held_out_before: Number
    held_out_after: Number
    gain: Number
    gain_low: Number
    gain_high: Number


class Rung(StudyModel):
    """One model of the ladder; errors are relative (0..1)."""

    model_id: int
    parent_id: int | None
    effects: list[str]
    added: str | None
    removed: str | None
    training: Number
    held_out: Number
    held_out_low: Number
    held_out_high: Number
    held_out_kind: str = Field(description="hold-out, leave-one-trial-out or leave-one-block-out")
    breakaway: BreakawayRung | None = Field(description="null: too few starts from rest, or a model of older versions")
    trials: int | None = Field(description="of the study when the model was fitted; null: in models of older versions")
    motion: RungMotion | None = Field(description="null: not simulated in closed loop yet")
    reflected_error_g: float | None = Field(
        description="error of the reflected load in motion with the model at work on the bench, rms; null: not tried"
    )
    gain: StepGain | None = Field(
        default=None, description="that of its change; null: a first model, more trials, or a model of older versions"
    )
    shows: str = Field(
        default="",
        description="where its change shows, though these errors do not count that; empty where they do",
        examples=["near reversals"],
    )


class Ladder(StudyModel):
    """The error from model to model, down towards the floor."""

    study_id: int
    effort: EffortName
    floor: float | None = Field(
        description="relative error that repeated trials set, by the model that predicts best; null without repeats"
    )
    rows: str = Field(description="which rows the errors are of", examples=["steady sliding"])
    rungs: list[Rung]
