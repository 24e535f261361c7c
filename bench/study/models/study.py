"""A study: its trials, what they are used for, and the model that it stands at."""

from datetime import datetime

from pydantic import Field

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
