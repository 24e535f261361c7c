"""GET of /studies: what is computed from a study. It stays the same until a model is added, and is not sent twice."""

from functools import partial
from typing import TYPE_CHECKING, Annotated

from fastapi import Depends, Query, Request, Response

from bench.service.auth.access import allow_read
from bench.service.compute import in_lab
from bench.service.http import conditional
from bench.service.http.api_router import api_router
from bench.service.http.downloads import attachment
from bench.service.http.problems import problems
from bench.service.routes.studies import StudyId
from bench.service.services import RunnerOf, StoreOf
from bench.study.models.closed_loop import ClosedLoop
from bench.study.models.comparison import Comparison
from bench.study.models.diagnosis import Diagnosis
from bench.study.models.ladder import Ladder
from bench.study.models.plots import Action, DriversOverTime, ErrorMap, Moments
from bench.study.models.study import Study
from bench.study.models.units import UnitComparison

if TYPE_CHECKING:
    import bench.study.closed_loop
    import bench.study.compare
    import bench.study.create
    import bench.study.diagnosis.diagnose
    import bench.study.ladder
    import bench.study.plots.error_map
    import bench.study.plots.moments
    import bench.study.plots.series
    import bench.study.report.report
    import bench.study.units
else:
    from bench.service.later import bench

REPORT = {"schema": {"type": "string"}, "example": "<!doctype html><title>Study 1</title>..."}
router = api_router("/studies", tags=["studies"], dependencies=[Depends(allow_read)])
ModelId = Annotated[int | None, Query(ge=1, description="which model; without it, the newest of the study")]
Refine = Annotated[
    bool, Query(description="refine the coefficients by it, too; nothing of that is kept, and it takes longer")
]


def kept(request: Request, response: Response, store: StoreOf, study_id: StudyId) -> None:
    """Dependency of what is computed from a study: it stays the same as long as no model is added or removed.

    The catalogue of effects is part of it too, which is read at the start of the service.
    """
    found = store.study(study_id)
    # what was kept with a model later, its error on the bench or in closed loop, is part of the ladder, too
    models = [(model.id, model.created_utc, sorted(model.result)) for model in store.models(study_id)]
    response.headers.update(conditional.unless_known(request, request.app.state.life, found, models))


answer = partial(router.get, dependencies=[Depends(kept)], responses=problems(404, 422) | conditional.ANSWER)


@router.get(
    "/{study_id}",
    summary="One study",
    dependencies=[Depends(kept)],
    responses=problems(404) | conditional.ANSWER,
)
async def one_study(request: Request, study_id: StudyId) -> Study:
    """Its trials, their roles, and the newest model."""
    return await in_lab(request, bench.study.create.describe, study_id)


@answer("/{study_id}/compare", summary="Measured against predicted")
async def compare_model(request: Request, study_id: StudyId, model_id: ModelId = None) -> Comparison:
    """Series, residual against each driving variable with bands, error per trial and regime, parameters."""
    return await in_lab(request, bench.study.compare.compare, study_id, model_id)


@answer("/{study_id}/diagnose", summary="Which effect is missing")
async def diagnose_model(request: Request, study_id: StudyId, model_id: ModelId = None) -> Diagnosis:
    """Effects ranked by evidence; those that the data cannot tell apart are one class. Takes seconds."""
    return await in_lab(request, bench.study.diagnosis.diagnose.diagnose, study_id, model_id)


@answer("/{study_id}/ladder", summary="The error from model to model")
async def all_models(request: Request, study_id: StudyId) -> Ladder:
    """Training and held-out error of every model of the study."""
    return await in_lab(request, bench.study.ladder.ladder, study_id)


@router.get(
    "/{study_id}/report",
    summary="One HTML file to be filed",
    response_class=Response,
    responses={
        200: {
            "description": "Needs no network.",
            "content": {"text/html": REPORT},
            "headers": attachment("study-1.html"),
        },
        **problems(404, 422),
    },
)
async def report(request: Request, runner: RunnerOf, study_id: StudyId) -> Response:
    """Trials, ladder, model, pictures, diagnosis, what to record next, provenance. Takes seconds."""
    page = await in_lab(request, bench.study.report.report.report_html, study_id, runner.configuration)
    headers = {"Content-Disposition": f'attachment; filename="study-{study_id}.html"'}
    return Response(page, media_type="text/html", headers=headers)


@answer("/{study_id}/closed-loop", summary="Where the model's joint goes")
async def closed_loop(
    request: Request, study_id: StudyId, model_id: ModelId = None, refine: Refine = False
) -> ClosedLoop:
    """Error of the motion beside that of the effort. Takes seconds."""
    return await in_lab(request, bench.study.closed_loop.simulate, study_id, model_id, refine)


@router.get("/{study_id}/units", summary="Units of one kind, and which is an outlier", responses=problems(404, 422))
async def units(
    request: Request,
    study_id: StudyId,
    beside: Annotated[list[int], Query(min_length=1, max_length=1000, description="a study for each other unit")],
    model_id: ModelId = None,
) -> UnitComparison:
    """All are fitted with this study's model: what they have in common, how they scatter; of two, what differs.

    Takes seconds.
    """
    return await in_lab(request, bench.study.units.compare_units, study_id, beside, model_id)


@router.get("/{study_id}/error-map", summary="Error over speed and load", responses=problems(404, 422))
async def error_map(request: Request, study_id: StudyId, model_id: ModelId = None) -> ErrorMap:
    """Where the model is wrong. Ask /moments with the edges of a cell to see when that was."""
    return await in_lab(request, bench.study.plots.error_map.error_map, study_id, model_id)


@router.get("/{study_id}/moments", summary="When the joint was somewhere", responses=problems(404, 422))
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
    return await in_lab(request, bench.study.plots.moments.moments, study_id, where, model_id)


@router.get("/{study_id}/action", summary="Where a missing effect would act", responses=problems(404, 422))
async def action(
    request: Request,
    study_id: StudyId,
    effect: Annotated[str, Query(max_length=100, description="its name", examples=["viscous_asymmetry"])],
    model_id: ModelId = None,
) -> Action:
    """The moments in which it takes most of the residual away, and every trial predicted with it. Nothing is kept."""
    return await in_lab(request, bench.study.plots.moments.action, study_id, effect, model_id)


@answer("/{study_id}/drivers", summary="What drives the residual, over time")
async def drivers(
    request: Request, study_id: StudyId, trial_id: Annotated[int, Query(ge=1, description="of the study")]
) -> DriversOverTime:
    """Speed, load, position and others of one trial, at the times of its series in /compare."""
    return await in_lab(request, bench.study.plots.series.drivers_over_time, study_id, trial_id)
