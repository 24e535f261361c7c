"""/experiment-kinds and /experiments: what can be started, starting it, and what has been run."""

import tempfile
from contextlib import suppress
from pathlib import Path as FilePath
from typing import Annotated

from fastapi import Depends, Path, Query, Request, Response
from fastapi.responses import FileResponse, StreamingResponse
from pydantic import BaseModel, ConfigDict, Field

from bench.experiments.registry import KINDS, find_kind
from bench.json_types import Json
from bench.service.auth.access import Operator, allow_read, require_operator
from bench.service.auth.audit_trail import note
from bench.service.compute import at_bench
from bench.service.http import conditional
from bench.service.http.api_router import api_router
from bench.service.http.downloads import PARQUET, PARQUET_ANSWER, attachment
from bench.service.http.exports import Export, export
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.service.http.repeated_start import Key, once
from bench.service.records import Experiment
from bench.service.routes.leases import LeaseOf
from bench.service.routes.queue_models import NewExperiment, Note, Tags
from bench.service.routes.refused_fields import told_at_its_fields
from bench.service.services import RunnerOf, StoreOf
from bench.service.stops import StopsOf
from bench.store.errors import StoreError
from bench.store.tables.tags import LONGEST_TAG

router = api_router(tags=["experiments"], dependencies=[Depends(allow_read)])
ExperimentId = Annotated[int, Path(ge=1, description="number of the experiment")]


class Kind(BaseModel):
    """One kind of experiment and the schema of its parameters."""

    name: str = Field(examples=["steps"])
    title: str
    summary: str
    parameters: Json = Field(description="JSON schema; each property has its `unit`, bounds and default")


class Kinds(Page):
    """One page of kinds, by name."""

    items: list[Kind]


class Annotation(BaseModel):
    """What is changed of an experiment; what is left out stays."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"tags": ["winter", "new grease"]}]})
    tags: Tags | None = None
    note: Note | None = None


class Started(BaseModel):
    """The experiment that has begun."""

    experiment_id: int
    kind: str


class Experiments(Page):
    """One page of experiments, newest first."""

    items: list[Experiment]


@router.get("/experiment-kinds", summary="What can be started", responses=problems(422))
def kinds(limit: Limit = 100, offset: Offset = 0) -> Kinds:
    """Each kind with the JSON schema of its parameters: units, bounds, defaults."""
    found, page = cut(list(KINDS.values())[offset : offset + limit + 1], limit, offset)
    items = [
        Kind(name=kind.name, title=kind.title, summary=kind.summary, parameters=kind.parameters.model_json_schema())
        for kind in found
    ]
    return Kinds(items=items, **page)


@router.post(
    "/experiments",
    status_code=201,
    summary="Start an experiment: the joint moves",
    responses=problems(401, 403, 404, 409, 422, 502),
)
async def start(
    runner: RunnerOf,
    store: StoreOf,
    lease: LeaseOf,
    caller: Operator,
    request: Request,
    response: Response,
    body: NewExperiment,
    stops: StopsOf,
    key: Key = None,
) -> Started:
    """Refused before any motion (422, with field, value, limit and unit) where it would leave the limits.

    409 while another one runs, or somebody else has the bench. Watch it with GET /live, end it with POST /stop.
    """

    def begin() -> Started:
        with stops.starting(), lease.starting(caller.name), told_at_its_fields(find_kind(body.kind)):
            begun = runner.start(body.kind, body.parameters, body.operator, body.note, body.pace)
        note(request, f"started experiment {begun} ({body.kind})")
        return Started(experiment_id=begun, kind=body.kind)

    def begun_once() -> Started:
        body.refuse_mistyped()  # a typing error is no failed start: nothing is recorded
        started = once(store.access.start_keys, caller.name, key, body.model_dump(), begin, Started)
        if body.tags:
            with suppress(StoreError):  # it runs all the same; PATCH can tell them again
                store.annotate(started.experiment_id, tags=body.tags)
        return started

    started = await at_bench(request, begun_once)
    response.headers["Location"] = f"{request.url.path}/{started.experiment_id}"
    return started


@router.get("/experiments", summary="What has been run", responses=problems(422))
def experiments(
    store: StoreOf,
    kind: Annotated[str, Query(max_length=100)] = "",
    outcome: Annotated[str, Query(max_length=20)] = "",
    tag: Annotated[str, Query(max_length=LONGEST_TAG, description="only those with this tag")] = "",
    limit: Limit = 100,
    offset: Offset = 0,
) -> Experiments:
    """Newest first, failed starts included."""
    found = store.experiments(kind or None, outcome or None, tag=tag or None, limit=limit + 1, offset=offset)
    items, page = cut(found, limit, offset)
    return Experiments(items=[Experiment.model_validate(one) for one in items], **page)


@router.get("/experiments/{experiment_id}", summary="One experiment", responses=problems(404) | conditional.ANSWER)
def experiment(store: StoreOf, request: Request, response: Response, experiment_id: ExperimentId) -> Experiment:
    """Parameters, provenance, outcome and why, results. With an `ETag`, which changes when it does."""
    found = Experiment.model_validate(store.experiment(experiment_id))
    response.headers.update(conditional.unless_known(request, found.model_dump()))
    return found


@router.patch(
    "/experiments/{experiment_id}",
    summary="Change tags and note of an experiment",
    dependencies=[Depends(require_operator)],
    responses=problems(401, 403, 404, 422),
)
def annotate(store: StoreOf, request: Request, experiment_id: ExperimentId, body: Annotation) -> Experiment:
    """Also of one that has ended; what was measured stays as it is."""
    store.annotate(experiment_id, body.note, body.tags)
    note(request, f"changed tags or note of experiment {experiment_id}")
    return Experiment.model_validate(store.experiment(experiment_id))


def _known(store: StoreOf, request: Request, experiment_id: ExperimentId) -> dict[str, str]:
    """Headers of what is made from a whole experiment: it does not change any more once that has ended."""
    found = store.experiment(experiment_id)
    if found.finished_utc is None:
        return {}
    return conditional.unless_known(request, found, store.trials(experiment_id))


Known = Annotated[dict[str, str], Depends(_known)]


@router.get(
    "/experiments/{experiment_id}/recording-set",
    summary="All its trials as a recording set (zip)",
    response_class=FileResponse,
    responses={
        200: {
            "description": "rig.toml, trials.csv and one CSV per trial; importing it gives the same numbers.",
            "content": {"application/zip": {"schema": {"type": "string", "format": "binary"}}},
            "headers": attachment("experiment-1.zip"),
        },
        **problems(404, 409, 503),
        **conditional.ANSWER,
    },
)
async def recording_set(store: StoreOf, request: Request, experiment_id: ExperimentId, known: Known) -> Response:
    """Written to a temporary file first, so that an error is an answer and not half a file. With an `ETag`."""

    def write() -> Export:
        from bench.recording_set import export_experiment  # imported when needed: the service starts without it

        folder = tempfile.TemporaryDirectory(prefix="friction-bench-")
        path = FilePath(folder.name) / f"experiment-{experiment_id}.zip"
        try:
            export_experiment(store, experiment_id, path)
        except BaseException:
            folder.cleanup()
            raise
        return Export(path, "application/zip", known, path.name, folder.cleanup)

    return await export(request, write)


@router.get(
    "/experiments/{experiment_id}/parquet",
    summary="All its trials as one Parquet table",
    response_class=StreamingResponse,
    responses={200: PARQUET_ANSWER, **problems(404, 422, 503), **conditional.ANSWER},
)
async def parquet(store: StoreOf, request: Request, experiment_id: ExperimentId, known: Known) -> Response:
    """Columns trial_id, trial, one per channel and condition. 422 where it has no rows, or pyarrow is not installed."""

    def write() -> Export:
        from bench.recording_set import export_parquet

        return Export(export_parquet(store, experiment_id), PARQUET, known, f"experiment-{experiment_id}.parquet")

    return await export(request, write)
