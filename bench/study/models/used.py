"""A model that was handed to the bench."""

from pydantic import Field

from bench.study.models.base import StudyModel


class Used(StudyModel):
    """The calibration that a model was kept as."""

    calibration_id: int
    study_id: int
    model_id: int
    effects: list[str] = Field(description="of the model, those at work")
    left_out: list[str] = Field(description="effects that need more than the motion of the moment")
    sentence: str
