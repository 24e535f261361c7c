"""/studies/{id}/closed-loop: a model under the servo that its trials ran under."""

from typing import Annotated

from fastapi import APIRouter, Depends, Path, Query, Request

from bench.service.auth.access import allow_read
from bench.service.compute import in_lab
from bench.service.http import conditional
from bench.service.http.problems import problems
from bench.service.routes.studies import kept
from bench.study.closed_loop import simulate
from bench.study.models.closed_loop import ClosedLoop

router = APIRouter(prefix="/studies/{study_id}", tags=["studies"], dependencies=[Depends(allow_read)])
StudyId = Annotated[int, Path(ge=1, description="number of the study")]
ModelId = Annotated[int | None, Query(ge=1, description="which model; without it, the newest of the study")]
Refine = Annotated[
    bool, Query(description="refine the coefficients by it, too; nothing of that is kept, and it takes longer")
]


@router.get(
    "/closed-loop",
    summary="Where the model's joint goes",
    dependencies=[Depends(kept)],
    responses=problems(404, 422) | conditional.ANSWER,
)
async def closed_loop(
    request: Request, study_id: StudyId, model_id: ModelId = None, refine: Refine = False
) -> ClosedLoop:
    """Error of the motion beside that of the effort. Takes seconds."""
    return await in_lab(request, simulate, study_id, model_id, refine)
