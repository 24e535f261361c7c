"""What drives the residual, over time."""

from pydantic import Field

from bench.json_types import Numbers
from bench.study.models.base import StudyModel


class DriverValues(StudyModel):
    """One driving variable over time."""

    driver: str = Field(examples=["velocity"])
    title: str
    unit: str
    values: Numbers


class DriversOverTime(StudyModel):
    """The driving variables of one trial, at the times of its series; all lists have the same length."""

    study_id: int
    trial_id: int
    time_s: Numbers
    drivers: list[DriverValues]
