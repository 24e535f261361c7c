"""A study with more trials."""

from pydantic import Field

from bench.json_types import Number
from bench.study.models.base import StudyModel


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
