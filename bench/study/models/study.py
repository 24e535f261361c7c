"""A study: its trials, what they are used for, and the model that it stands at."""

from datetime import datetime

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import Condition, EffortName, Role, StudyModel


class StudyTrial(StudyModel):
    """One trial of a study and what it is used for."""

    trial_id: int
    name: str
    role: Role
    conditions: dict[str, Condition]


class ModelName(StudyModel):
    """One model of a study."""

    model_id: int
    parent_id: int | None = Field(description="null: the first model")
    effects: list[str]


class Study(StudyModel):
    """A study: its trials, and the model that it stands at."""

    study_id: int
    name: str
    effort: EffortName
    cutoff_hz: float = Field(description="low-pass to which effort and motion are filtered alike [Hz]")
    rows: str = Field(description="which rows count: sliding, moving or all")
    trials: list[StudyTrial]
    left_out: list[str] = Field(description="names of trials that are too short for the low-pass")
    models: list[ModelName] = Field(description="in the order in which they were made")
    model_id: int = Field(description="the base model at creation, the newest model later")


class StudyName(StudyModel):
    """One line of the list of studies."""

    study_id: int
    name: str
    created_utc: datetime


class AddedTrial(StudyModel):
    """A trial that a study was given."""

    trial_id: int
    name: str


class Extended(StudyModel):
    """The study with more trials; errors are relative (0..1)."""

    study_id: int
    model_id: int = Field(description="the newest model, fitted to all trials")
    added: list[AddedTrial]
    left_out: list[str] = Field(description="trials too short for the study's filter, or without its effort")
    trials: int
    before: Number
    after: Number
    sentence: str


def note_for(study_id: int) -> str:
    """Kept with the record of an experiment that was run for a study: by it the study finds its trials again."""
    return f"suggested by study {study_id}"
