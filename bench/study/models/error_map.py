"""Where a model is wrong: cells of speed and load."""

from pydantic import Field

from bench.json_types import Numbers
from bench.study.models.base import EffortName, StudyModel


class Axis(StudyModel):
    """One side of the map."""

    driver: str = Field(description="to be used in `where` of /moments", examples=["velocity"])
    title: str
    unit: str


class ErrorMap(StudyModel):
    """Error in cells; the first index counts along `down`, the second along `across`. Null: too few rows."""

    study_id: int
    model_id: int
    effort: EffortName
    across: Axis
    down: Axis
    across_edges: list[float]
    down_edges: list[float]
    rms: list[Numbers] = Field(description="of the residual, in the unit of the effort")
    mean: list[Numbers] = Field(description="of the residual, in the unit of the effort")
    count: list[list[int]]
