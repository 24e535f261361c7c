"""/trials: what was recorded, down-sampled for a plot or whole as CSV."""

import math
from dataclasses import asdict
from datetime import date
from typing import Annotated, Literal

from fastapi import Depends, Path, Query, Request, Response
from fastapi.responses import StreamingResponse
from pydantic import BaseModel, Field, FiniteFloat

from bench.errors import ParameterError
from bench.service.auth.access import allow_read
from bench.service.http import conditional
from bench.service.http.api_router import api_router
from bench.service.http.downloads import PARQUET, PARQUET_ANSWER, attachment, samples_json
from bench.service.http.exports import Export, export
from bench.service.http.pages import Limit, Offset, Page, cut
from bench.service.http.problems import problems
from bench.service.records import Trial
from bench.service.services import StoreOf
from bench.store.records import Trial as StoredTrial
from bench.store.tables.days import begin_and_end
from bench.store.tables.trial_search import TrialQuery

router = api_router("/trials", tags=["trials"], dependencies=[Depends(allow_read)])
LEAST_PER_CHANNEL = 10
Sorting = Literal["trial", "name", "kind", "outcome", "rows"]
KindName = Annotated[str, Query(max_length=100, description="exact kind, such as `steps`")]
OutcomeName = Annotated[str, Query(max_length=20, description="exact outcome, such as `completed`")]
TrialId = Annotated[int, Path(ge=1, description="number of the trial")]


class Event(BaseModel):
    """Something that happened during a trial."""

    time_s: float
    name: str
    detail: str


class TrialWithEvents(Trial):
    """A trial and its events."""

    events: list[Event]


class Trials(Page):
    """One page of trials, in the order in which they were made."""

    items: list[Trial]


class Gap(BaseModel):
    """A stretch of a trial in which nothing was recorded."""

    from_s: float
    to_s: float


class Samples(BaseModel):
    """Channels of one trial; all lists have the same length, a quantity that was not measured is null."""

    trial_id: int
    rows_recorded: int
    rows_returned: int
    gaps: list[Gap] = Field(default=[], description="where nothing was recorded; told of trials that were imported")
    channels: dict[str, list[float | None]]


@router.get("", summary="Trials, filtered", responses=problems(422))
def trials(
    store: StoreOf,
    experiment_id: Annotated[int | None, Query(ge=1)] = None,
    kind: KindName = "",
    outcome: OutcomeName = "",
    limit: Limit = 100,
    offset: Offset = 0,
) -> Trials:
    """In the order in which they were made. Without filters: all trials."""
    found = store.trials(experiment_id, kind or None, outcome or None, limit=limit + 1, offset=offset)
    items, page = cut(found, limit, offset)
    return Trials(items=[Trial.model_validate(trial) for trial in items], **page)


class FoundTrials(Page):
    """One page of the trials that were looked for."""

    total: int = Field(description="how many there are in all", examples=[1])
    items: list[Trial]


class RecordedDay(BaseModel):
    """A day on which something was begun."""

    day: date
    experiments: int
    trials: int = Field(description="of the experiments that were begun on that day")
    not_completed: int = Field(description="trials that ended otherwise, or still run")


class Days(Page):
    """The newest days on which something was begun, newest first."""

    items: list[RecordedDay]


OffsetMin = Annotated[
    int, Query(ge=-24 * 60 + 1, le=24 * 60 - 1, description="of the local time of a day, ahead of UTC [min]")
]


@router.get("/days", summary="On which days something was recorded", responses=problems(422))
def recorded_days(store: StoreOf, offset_min: OffsetMin = 0, limit: Limit = 60, offset: Offset = 0) -> Days:
    """For a strip of sessions; `day` of /trials/search gives the trials of one."""
    items, page = cut(store.days(offset_min, offset + limit + 1)[offset:], limit, offset)
    return Days(items=[RecordedDay(**asdict(one)) for one in items], **page)


@router.get("/search", summary="Trials by words, sorted, page by page", responses=problems(422))
def search(
    store: StoreOf,
    words: Annotated[str, Query(max_length=200, description="each is in the name, kind, outcome or a condition")] = "",
    experiment_id: Annotated[int | None, Query(ge=1)] = None,
    kind: KindName = "",
    outcome: OutcomeName = "",
    day: Annotated[date | None, Query(description="on which the experiment was begun")] = None,
    offset_min: OffsetMin = 0,
    sort: Annotated[Sorting, Query(description="what they are sorted by")] = "trial",
    descending: Annotated[bool, Query(description="the highest, or newest, first")] = True,
    limit: Limit = 50,
    offset: Offset = 0,
) -> FoundTrials:
    """For a list that a person looks through; a page of 100 000 trials comes as quickly as one of ten."""
    begun = None if day is None else begin_and_end(day, offset_min)
    wanted = TrialQuery(
        experiment_id,
        kind or None,
        outcome or None,
        tuple(words.split()),
        begun,
        sort=sort,
        descending=descending,
    )
    found, total = store.search_trials(wanted, limit, offset)
    more = offset + limit if offset + limit < total else None
    items = [Trial.model_validate(trial) for trial in found]
    return FoundTrials(items=items, total=total, limit=limit, offset=offset, next_offset=more)


@router.get("/{trial_id}", summary="One trial with its events", responses=problems(404) | conditional.ANSWER)
def trial(store: StoreOf, request: Request, response: Response, trial_id: TrialId) -> TrialWithEvents:
    """Conditions, outcome and why, results, channels, events. With an `ETag`, which changes when it does."""
    events = [Event(time_s=one.time_s, name=one.name, detail=one.detail) for one in store.events(trial_id)]
    found = TrialWithEvents(**dict(Trial.model_validate(store.trial(trial_id))), events=events)
    response.headers.update(conditional.unless_known(request, found.model_dump()))
    return found


def _known(request: Request, found: StoredTrial) -> dict[str, str]:
    """Headers of what is made from a trial's samples: they do not change any more once it has ended."""
    return {} if found.finished_utc is None else conditional.unless_known(request, found)


def _asked(store: StoreOf, request: Request, trial_id: TrialId) -> tuple[StoredTrial, dict[str, str]]:
    """A trial whose samples are asked for, and the headers of what is made from them."""
    found = store.trial(trial_id)
    return found, _known(request, found)


Asked = Annotated[tuple[StoredTrial, dict[str, str]], Depends(_asked)]


@router.get(
    "/{trial_id}/samples",
    summary="Samples, down-sampled on request",
    response_model=Samples,
    responses=problems(404, 422) | conditional.ANSWER,
)
def samples(
    store: StoreOf,
    request: Request,
    trial_id: TrialId,
    channels: Annotated[
        str,
        Query(max_length=2000, description="names, comma-separated; without: all", examples=["time_s,position_rad"]),
    ] = "",
    points: Annotated[
        int, Query(ge=10, le=200_000, description="about how many rows at most; the extremes of every channel are kept")
    ] = 4000,
    from_s: Annotated[FiniteFloat | None, Query(description="begin of a stretch; without: of the trial [s]")] = None,
    to_s: Annotated[FiniteFloat | None, Query(description="end of a stretch; without: of the trial [s]")] = None,
) -> Response:
    """Every returned row is a recorded row: nothing is averaged. `time_s` always comes along."""
    if from_s is not None and to_s is not None and from_s > to_s:
        raise ParameterError(f"from_s is {from_s:g} s, beyond to_s, which is {to_s:g} s; exchange them")
    found = store.trial(trial_id)
    headers = _known(request, found)
    names = [name for name in channels.split(",") if name] or list(found.channels)
    # the store keeps rows for each channel; together they are to stay near `points`
    share = max(LEAST_PER_CHANNEL, points // len(names))
    stretch = None if from_s is None and to_s is None else (_or(from_s, -math.inf), _or(to_s, math.inf))
    reduced = store.samples_reduced(trial_id, names, share, stretch)
    # our own control loop records at one period
    gaps = store.time_gaps(trial_id) if store.experiment(found.experiment_id).source == "imported" else []
    return Response(samples_json(trial_id, found.rows, reduced, gaps), media_type="application/json", headers=headers)


def _or(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


@router.get(
    "/{trial_id}/csv",
    summary="The whole trial as CSV",
    response_class=StreamingResponse,
    responses={
        200: {
            "description": "One line per row; SI, the unit in the column's name, empty where not measured.",
            "content": {"text/csv": {"example": "time_s,position_rad,current_a\n0.0,0.0,0.012\n"}},
            "headers": attachment("trial-1.csv"),
        },
        **problems(404, 503),
        **conditional.ANSWER,
    },
)
async def csv(
    store: StoreOf,
    request: Request,
    asked: Asked,
    every_channel: Annotated[bool, Query(description="channels too that no recording set holds")] = False,
) -> Response:
    """The same file that a recording set holds for the trial: numbers are exact."""
    found, known = asked

    def write() -> Export:
        from bench.recording_set import csv_chunks, stream_of_trial  # when needed: the service starts without it

        chunks = csv_chunks(stream_of_trial(store, found, every_channel))
        return Export(chunks, "text/csv; charset=utf-8", known, f"trial-{found.id}.csv")

    return await export(request, write)


@router.get(
    "/{trial_id}/parquet",
    summary="The whole trial as Parquet",
    response_class=StreamingResponse,
    responses={200: PARQUET_ANSWER, **problems(404, 422, 503), **conditional.ANSWER},
)
async def parquet(store: StoreOf, request: Request, asked: Asked) -> Response:
    """One column per channel and condition; null where not measured. 422 where pyarrow is not installed."""
    found, known = asked

    def write() -> Export:
        from bench.recording_set import parquet_chunks, stream_of_trial

        chunks = parquet_chunks([stream_of_trial(store, found)])
        return Export(chunks, PARQUET, known, f"trial-{found.id}.parquet")

    return await export(request, write)
