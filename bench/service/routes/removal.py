"""DELETE /experiments/N and /studies/N: a record that nobody needs is removed for good. An admin's, with a reason."""

from typing import Annotated

from fastapi import Depends, Path, Query, Request

from bench.service.auth.access import require_admin
from bench.service.auth.audit_trail import note
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.services import StoreOf

router = api_router(dependencies=[Depends(require_admin)])
Number = Annotated[int, Path(ge=1, description="its number")]
Reason = Annotated[
    str, Query(min_length=1, max_length=200, pattern=r"\S", description="why; kept in the audit log, with who and when")
]
ANSWERS = problems(401, 403, 404, 409, 422)


@router.delete(
    "/experiments/{experiment_id}",
    status_code=204,
    tags=["experiments"],
    summary="Remove an experiment with all its data",
    responses=ANSWERS,
)
def remove_experiment(store: StoreOf, request: Request, experiment_id: Number, reason: Reason) -> None:
    """For good: trials, samples and events with it. 409 while it runs, or while a study or a calibration uses it."""
    removed = store.removal.experiment(experiment_id)
    note(request, f"removed {removed}: {reason}")


@router.delete(
    "/studies/{study_id}",
    status_code=204,
    tags=["studies"],
    summary="Remove a study with its models",
    responses=ANSWERS,
)
def remove_study(store: StoreOf, request: Request, study_id: Number, reason: Reason) -> None:
    """Its trials stay. 409 while a calibration carries a model of it."""
    removed = store.removal.study(study_id)
    note(request, f"removed {removed}: {reason}")
