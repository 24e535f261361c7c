"""/studies/{id}/closed-loop: a model under the servo that its trials ran under."""

from typing import Annotated, Literal

from fastapi import APIRouter, Depends, Path, Query, Request
from pydantic import BaseModel, Field

from bench.service.auth.access import allow_read
from bench.service.compute import in_lab
from bench.service.http import conditional
from bench.service.http.problems import problems
from bench.service.models.study_models import EffortName, Numbers, Role
from bench.service.routes.studies import kept

router = APIRouter(prefix="/studies/{study_id}", tags=["studies"], dependencies=[Depends(allow_read)])
StudyId = Annotated[int, Path(ge=1, description="number of the study")]
ModelId = Annotated[int | None, Query(ge=1, description="which model; without it, the newest of the study")]
Refine = Annotated[
    bool, Query(description="refine the coefficients by it, too; nothing of that is kept, and it takes longer")
]


class LoopError(BaseModel):
    """Errors over the samples at which the loop is closed; relative ones are shares (0..1)."""

    samples: int
    position: float | None = Field(description="root mean square, in the unit of the position")
    position_relative: float | None = Field(description="over the standard deviation of the measured position")
    velocity_relative: float | None = Field(description="over the root mean square of the measured speed")
    effort: float | None = Field(description="root mean square, in the unit of the effort")
    effort_relative: float | None = Field(description="over that of the measured effort")


class Motion(BaseModel):
    """Measured and simulated position over time; all lists have the same length."""

    time_s: Numbers
    measured: Numbers
    simulated: Numbers


class TrialInLoop(LoopError):
    """One trial."""

    trial_id: int
    name: str
    role: Role
    law: Literal["bench", "recording", "stand-in"] = Field(
        description="who tells the servo's gains: the bench that closed the loop, set point and effort of the "
        "recording, or nobody, so that a servo of twice the motion's bandwidth stands in"
    )
    settled: bool = Field(description="False where friction decides, by less than the model knows, where it stops")
    series: Motion


class Coefficient(BaseModel):
    """One coefficient, by least squares along the measured motion and refined along the simulated one."""

    effect: str
    name: str
    unit: str
    before: float | None
    after: float | None


class Refined(BaseModel):
    """The same with refined coefficients."""

    training: LoopError
    held_out: LoopError | None
    passes: int
    gained: bool = Field(description="False: no coefficients are better in closed loop, and none changed")
    inverse_before: float | None = Field(description="relative error of the effort along the measured motion")
    inverse_after: float | None
    parameters: list[Coefficient]
    sentence: str


class ClosedLoop(BaseModel):
    """Where a model's joint goes, under the servo that the measured one ran under."""

    study_id: int
    model_id: int
    effects: list[str]
    effort: EffortName
    position_unit: Literal["rad", "m"]
    training: LoopError
    held_out: LoopError | None = Field(description="null: too few trials to leave one out in turn")
    trials: list[TrialInLoop]
    refined: Refined | None = Field(description="null: not asked for")
    notes: list[str]


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
    return ClosedLoop.model_validate(await in_lab(request, "simulate", study_id, model_id=model_id, refined=refine))
