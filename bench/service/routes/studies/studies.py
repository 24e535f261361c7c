"""/studies: make one, change its models, give it trials, hand a model to the bench. GET is in `study_answers`."""

from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import Depends, Path, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from bench.service.auth.access import allow_read, require_token
from bench.service.auth.audit_trail import note
from bench.service.compute import in_lab
from bench.service.http.api_router import api_router
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.service.routes.studies import StudyId
from bench.service.services import RunnerOf, StoreOf
from bench.store import Store
from bench.store.errors import NotFoundError
from bench.study.models.change import Changed, Searched
from bench.study.models.kept import Used
from bench.study.models.study import Extended, Study, StudyName
from bench.study.suggestion.suggested import Suggested

if TYPE_CHECKING:
    import bench.study.changes
    import bench.study.create
    import bench.study.diagnosis.search
    import bench.study.extend
    import bench.study.suggestion.suggest
    import bench.study.use
else:
    from bench.service.later import bench

router = api_router("/studies", tags=["studies"], dependencies=[Depends(allow_read)])
made = partial(router.post, status_code=201, dependencies=[Depends(require_token)], responses=problems(401, 404, 422))


class Studies(Page):
    """One page of studies, newest first."""

    items: list[StudyName]


class NewStudy(BaseModel):
    """Which trials, and which of them judge the model instead of being fitted."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "examples": [{"name": "arm, winter", "experiment_ids": [3, 4], "hold_out": ["load_kg=0.1"]}]
        },
    )
    name: str = Field(min_length=1, max_length=200)
    experiment_ids: list[int] = Field(min_length=1, max_length=1000, description="experiments whose trials are used")
    hold_out: list[str] = Field(
        default=[],
        max_length=1000,
        description="conditions that are held out, as key=value; the key is a condition, `trial` or `kind`. "
        "Without any, each trial is left out in turn",
        examples=[["load_kg=0.1", "trial=pulses"]],
    )
    where: list[str] = Field(
        default=[],
        max_length=1000,
        description="criteria key=value that a trial must meet to be used",
        examples=[["kind=steps"]],
    )
    rows: Literal["sliding", "moving", "all"] = Field(default="sliding", description="which rows count")
    cutoff_hz: float | None = Field(
        default=None, gt=0, le=1000, description="low-pass [Hz]; null: chosen from the data"
    )
    base: list[str] | None = Field(default=None, description="effects of the first model; null: the default base model")


class Change(BaseModel):
    """One effect more, or one less."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"examples": [{"effect": "viscous_asymmetry", "model_id": 7}]}
    )
    effect: str = Field(min_length=1, max_length=100, description="name from GET /effects")
    model_id: int | None = Field(default=None, ge=1, description="the parent; null: the newest model of the study")
    action: Literal["add", "drop"] = "add"


class SearchFrom(BaseModel):
    """Where a search begins, and how far it goes."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"most": 3}]})
    model_id: int | None = Field(default=None, ge=1, description="the first model; null: the newest model of the study")
    most: int = Field(default=4, ge=1, le=10, description="effects that are added at most")


class SuggestFrom(BaseModel):
    """What is to be told apart, and in how many trials."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"trials": 4}]})
    model_id: int | None = Field(default=None, ge=1, description="which model; null: the newest of the study")
    trials: int = Field(default=6, ge=1, le=50, description="trials at most")


class MoreTrials(BaseModel):
    """Experiments whose trials a study is given."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"experiment_ids": [7, 8]}]})
    experiment_ids: list[int] = Field(
        default=[], max_length=1000, description="none: every completed one with the note that the suggestion names"
    )


class UseModel(BaseModel):
    """Which model."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"model_id": 7}]})
    model_id: int | None = Field(default=None, ge=1, description="null: the newest of the study")


@made("", summary="Create a study")
async def create(request: Request, response: Response, body: NewStudy) -> Study:
    """Fixes the trials and fits the base model."""
    found = await in_lab(
        request,
        bench.study.create.create_study,
        body.name,
        body.experiment_ids,
        hold_out=body.hold_out,
        base=body.base,
        where=body.where,
        cutoff_hz=body.cutoff_hz,
        rows=body.rows,
    )
    response.headers["Location"] = f"{request.url.path}/{found.study_id}"
    note(request, f"made study {found.study_id} ({body.name})")
    return found


@router.get("", summary="The studies", responses=problems(422))
def studies(store: StoreOf, limit: Limit = 100, offset: Offset = 0) -> Studies:
    """Newest first."""
    found, page = cut(store.studies(limit + 1, offset), limit, offset)
    items = [StudyName(study_id=row.id, name=row.name, created_utc=row.created_utc) for row in found]
    return Studies(items=items, **page)


@made("/{study_id}/models", summary="Add an effect to a model, or drop one")
async def change(request: Request, study_id: StudyId, body: Change) -> Changed:
    """Refits and keeps the child model; answers with the error before and after."""
    function = bench.study.changes.add_effect if body.action == "add" else bench.study.changes.drop_effect
    found = await in_lab(request, function, study_id, body.effect, body.model_id)
    note(request, f"made model {found.model_id}: {body.action} {body.effect}")
    return found


@made("/{study_id}/search", summary="Add effects until nothing is missing")
async def search_effects(request: Request, study_id: StudyId, body: SearchFrom) -> Searched:
    """Adds, exchanges and drops effects one after the other; every model on the way is kept. Takes a while."""
    found = await in_lab(request, bench.study.diagnosis.search.search, study_id, body.model_id, body.most)
    note(request, f"made {len(found.steps)} models, the last of them {found.model_id}")
    return found


@router.post(
    "/{study_id}/suggest",
    summary="Which trials to record next",
    dependencies=[Depends(require_token)],
    responses=problems(401, 404, 422),
)
async def suggest_trials(request: Request, runner: RunnerOf, study_id: StudyId, body: SuggestFrom) -> Suggested:
    """Nothing moves: start each with POST /experiments, its kind, parameters and the note. Takes seconds."""
    return await in_lab(
        request, bench.study.suggestion.suggest.suggest, study_id, runner.configuration, body.model_id, body.trials
    )


@made("/{study_id}/trials", summary="Add trials to a study")
async def add_trials(request: Request, study_id: StudyId, body: MoreTrials) -> Extended:
    """Refits the newest model to all trials; earlier models stay what they were."""
    return await in_lab(request, bench.study.extend.extend_study, study_id, body.experiment_ids)


@made("/{study_id}/use", summary="Hand a model to the online compensator")
async def use_model(request: Request, runner: RunnerOf, study_id: StudyId, body: UseModel) -> Used:
    """Kept as a calibration, which the bench uses from the next experiment on."""
    return await in_lab(request, bench.study.use.use, study_id, runner.configuration, body.model_id)


@router.delete(
    "/{study_id}/models/{model_id}",
    status_code=204,
    summary="Remove a model",
    dependencies=[Depends(require_token)],
    responses=problems(401, 404, 409),
)
def remove(store: StoreOf, study_id: StudyId, model_id: Annotated[int, Path(ge=1)]) -> None:
    """Only a model that no other was made from."""
    model_of_study(store, study_id, model_id)
    store.remove_model(model_id)


def model_of_study(store: Store, study_id: int, model_id: int) -> None:
    """Check that the model belongs to the study.

    Raises:
        NotFoundError: it does not, or there is no such study.
    """
    store.study(study_id)
    found = [model.id for model in store.models(study_id)]
    if model_id not in found:
        raise NotFoundError(f"study {study_id} has no model {model_id}; it has {', '.join(map(str, found)) or 'none'}")
