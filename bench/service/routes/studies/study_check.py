"""/studies/check: whether trials can carry a model, and what to hold out, before a study is made of them."""

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from bench.service.auth.access import allow_read, require_viewer
from bench.service.compute import in_lab
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.store import Store
from bench.study.models.coverage import Checked

router = api_router("/studies", tags=["studies"], dependencies=[Depends(allow_read)])


class ToCheck(BaseModel):
    """Which trials a study would be made of."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"experiment_ids": [3, 4]}]})
    experiment_ids: list[int] = Field(min_length=1, max_length=1000, description="experiments whose trials are used")
    hold_out: list[str] = Field(default=[], max_length=1000, description="as of a new study")
    where: list[str] = Field(default=[], max_length=1000, description="as of a new study")


@router.post(
    "/check",
    summary="Can these trials carry a model?",
    dependencies=[Depends(require_viewer)],
    responses=problems(401, 404, 422),
)
async def check(request: Request, body: ToCheck) -> Checked:
    """Nothing is kept. Takes about as long as making the study without its fit."""
    return await in_lab(request, _checked, body)


def _checked(store: Store, body: ToCheck) -> Checked:
    from bench.study.carrying import check_trials  # the lab is imported when it is first needed

    return check_trials(store, body.experiment_ids, body.hold_out, body.where)
