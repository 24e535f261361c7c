"""/live: status and rows as they are recorded, as server-sent events or by polling."""

from typing import Annotated

from fastapi import Depends, Header, Path, Query, Request
from fastapi.responses import StreamingResponse
from pydantic import BaseModel

from bench.control.drive_factory import is_simulated
from bench.service.auth.access import allow_read
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.live.jobs import JobRecord, Jobs
from bench.service.live.live_events import LiveEvents
from bench.service.live.status import Rows, Status, rows_of, status_of
from bench.service.routes.leases import LeaseOf, lease_now
from bench.service.services import RunnerOf
from bench.store.errors import NotFoundError

MOST_ROWS = 2000
router = api_router("/live", tags=["live"], dependencies=[Depends(allow_read)])
AfterRow = Annotated[int, Query(ge=-1, description="only rows after this one; -1: all that are kept")]
MostRows = Annotated[int, Query(ge=1, le=20_000, description="most rows in one answer; the newest are sent")]
JobName = Annotated[str, Path(max_length=100, description="as the request gave it in `X-Job`", examples=["b7"])]
LastEvent = Annotated[str | None, Header(max_length=200, description="`id` of the rows that came last")]


class LiveNow(BaseModel):
    """Status and new rows in one answer."""

    status: Status
    rows: Rows


@router.get(
    "",
    summary="Status and new rows as they come (server-sent events)",
    response_class=StreamingResponse,
    responses={
        200: {
            "description": "`event: status` carries a Status (see GET /live/now), twice a second and at each change; "
            "`event: rows` carries Rows, twenty times a second while rows come; its `id` is for `Last-Event-ID`; "
            "`event: gap` carries a `detail`: which rows were missed and are not sent again.",
            "content": {"text/event-stream": {"example": 'event: status\ndata: {"state": "idle"}\n\n'}},
        }
    },
)
async def live(
    request: Request,
    after_row: AfterRow = -1,
    limit: MostRows = MOST_ROWS,
    last_event_id: LastEvent = None,
) -> StreamingResponse:
    """Open it and leave it open: `curl -N http://127.0.0.1:8000/api/v1/live`.

    With the `id` of the last `rows` event as `Last-Event-ID`, all rows since then come first, at most 2000 an event,
    from memory or from the store; what cannot be sent again is told by `event: gap`.
    """
    events: LiveEvents = request.app.state.live_events
    return StreamingResponse(
        events.stream(after_row, limit, last_event_id),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store"},
    )


@router.get("/now", summary="Status and new rows, once")
def now(runner: RunnerOf, lease: LeaseOf, after_row: AfterRow = -1, limit: MostRows = MOST_ROWS) -> LiveNow:
    """For programs that poll. Send `last_row` back as `after_row`."""
    simulated = is_simulated(runner.configuration)
    status = status_of(runner.status(), simulated, lease_now(lease.current()))
    return LiveNow(status=status, rows=rows_of(runner.live(after_row, limit)))


@router.get("/jobs/{job}", summary="How far a computation has come", responses=problems(404))
async def job_now(request: Request, job: JobName) -> JobRecord:
    """Of a request that gave itself a name in the header `X-Job`: a diagnosis tells its stages."""
    jobs: Jobs = request.app.state.jobs
    found = jobs.find(job)
    if found is None:
        raise NotFoundError(f"no job '{job}'; a request is one under the name in its header X-Job")
    return found.record()


@router.get(
    "/jobs/{job}/stream",
    summary="The same as it goes on (server-sent events)",
    response_class=StreamingResponse,
    responses={
        200: {
            "description": "`event: progress` carries a JobRecord (see GET /live/jobs/{job}) at each change, until the "
            "job has ended. To cancel it, break off the request itself.",
            "content": {"text/event-stream": {"example": 'event: progress\ndata: {"state": "computing"}\n\n'}},
        }
    },
)
async def job_stream(request: Request, job: JobName) -> StreamingResponse:
    """May be opened a little before the request; ends at once where none of that name comes."""
    jobs: Jobs = request.app.state.jobs
    events = jobs.stream(job, request.app.state)
    return StreamingResponse(events, media_type="text/event-stream", headers={"Cache-Control": "no-store"})
