"""/studies/{id}/error-map and /moments: where a model is wrong, and when the joint was there."""

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Query, Request
from pydantic import BaseModel, Field

from bench.service.auth.access import allow_read
from bench.service.compute import in_lab
from bench.service.http.problems import problems
from bench.service.models.study_models import EffortName, Numbers

router = APIRouter(prefix="/studies/{study_id}", tags=["studies"], dependencies=[Depends(allow_read)])
StudyId = Annotated[int, Path(ge=1, description="number of the study")]
ModelId = Annotated[int | None, Query(ge=1, description="which model; without it, the newest of the study")]


class Axis(BaseModel):
    """One side of the map."""

    driver: str = Field(description="to be used in `where` of /moments", examples=["velocity"])
    title: str
    unit: str


class ErrorMap(BaseModel):
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


class Moment(BaseModel):
    """A stretch of one trial during which every criterion held, but for pauses."""

    trial_id: int
    name: str
    from_s: float = Field(description="since the start of the trial")
    to_s: float
    rows: int
    rms: float | None
    mean: float | None


class Moments(BaseModel):
    """The moments with most error first."""

    study_id: int
    model_id: int
    effort: EffortName
    items: list[Moment]


@router.get("/error-map", summary="Error over speed and load", responses=problems(404, 422))
async def error_map(request: Request, study_id: StudyId, model_id: ModelId = None) -> ErrorMap:
    """Where the model is wrong. Ask /moments with the edges of a cell to see when that was."""
    return ErrorMap.model_validate(await in_lab(request, "error_map", study_id, model_id=model_id))


@router.get("/moments", summary="When the joint was somewhere", responses=problems(404, 422))
async def moments(
    request: Request,
    study_id: StudyId,
    where: Annotated[
        list[str],
        Query(min_length=1, max_length=10, description="driver=low..high, all of them", examples=["velocity=0.5..1"]),
    ],
    model_id: ModelId = None,
) -> Moments:
    """Stretches of trials, with the residual's size during each; at most a dozen."""
    return Moments.model_validate(await in_lab(request, "moments", study_id, where, model_id=model_id))
