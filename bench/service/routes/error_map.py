"""/studies/{id}/error-map and /moments: where a model is wrong, and when the joint was there."""

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Query, Request

from bench.service.auth.access import allow_read
from bench.service.compute import in_lab
from bench.service.http.problems import problems
from bench.study import error_map as study

router = APIRouter(prefix="/studies/{study_id}", tags=["studies"], dependencies=[Depends(allow_read)])
StudyId = Annotated[int, Path(ge=1, description="number of the study")]
ModelId = Annotated[int | None, Query(ge=1, description="which model; without it, the newest of the study")]


@router.get("/error-map", summary="Error over speed and load", responses=problems(404, 422))
async def error_map(request: Request, study_id: StudyId, model_id: ModelId = None) -> study.ErrorMap:
    """Where the model is wrong. Ask /moments with the edges of a cell to see when that was."""
    return await in_lab(request, study.error_map, study_id, model_id)


@router.get("/moments", summary="When the joint was somewhere", responses=problems(404, 422))
async def moments(
    request: Request,
    study_id: StudyId,
    where: Annotated[
        list[str],
        Query(min_length=1, max_length=10, description="driver=low..high, all of them", examples=["velocity=0.5..1"]),
    ],
    model_id: ModelId = None,
) -> study.Moments:
    """Stretches of trials, with the residual's size during each; at most a dozen."""
    return await in_lab(request, study.moments, study_id, where, model_id)
