"""/live: status and rows as they are recorded, as server-sent events or by polling."""

import asyncio
import json
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Depends, Header, Query, Request
from fastapi.responses import StreamingResponse
from pydantic import BaseModel, Field

from bench.bench_control import BenchControl
from bench.drive_factory import is_simulated
from bench.lease import Lease
from bench.live import LiveRows
from bench.service.access import allow_read
from bench.service.json_numbers import column
from bench.service.leases import LeaseOf, lease_now
from bench.service.services import RunnerOf
from bench.service.status import Status, status_of

PERIOD_S = 0.05
STATUS_EVERY = 10  # periods; in between, only what is new is sent
MOST_ROWS = 2000
router = APIRouter(prefix="/live", tags=["live"], dependencies=[Depends(allow_read)])
AfterRow = Annotated[int, Query(ge=-1, description="only rows after this one; -1: all that are kept")]
MostRows = Annotated[int, Query(ge=1, le=20_000, description="most rows in one answer; the newest are sent")]
LastEvent = Annotated[str | None, Header(description="resume after this row; browsers send it by themselves")]


class Rows(BaseModel):
    """Rows since `after_row`. A quantity that was not measured is null."""

    channels: list[str]
    rows: list[list[float | None]]
    last_row: int = Field(description="send it as `after_row` next time")
    restarted: bool = Field(description="True where rows before these belong to something else or are gone")


class LiveNow(BaseModel):
    """Status and new rows in one answer."""

    status: Status
    rows: Rows


def rows_of(found: LiveRows) -> Rows:
    """Rows for JSON."""
    rows = [column(row) for row in found.rows]
    return Rows(channels=list(found.channels), rows=rows, last_row=found.last_row, restarted=found.restarted)


@router.get(
    "",
    summary="Status and new rows as they come (server-sent events)",
    response_class=StreamingResponse,
    responses={
        200: {
            "description": "`event: status` carries a Status (see GET /live/now), twice a second and at each change; "
            "`event: rows` carries Rows, twenty times a second while rows come; its `id` is `last_row`.",
            "content": {"text/event-stream": {"example": 'event: status\ndata: {"state": "idle"}\n\n'}},
        }
    },
)
async def live(
    request: Request,
    runner: RunnerOf,
    lease: LeaseOf,
    after_row: AfterRow = -1,
    limit: MostRows = MOST_ROWS,
    last_event_id: LastEvent = None,
) -> StreamingResponse:
    """Open it and leave it open: `curl -N http://127.0.0.1:8000/api/v1/live`."""
    if last_event_id is not None and last_event_id.isdigit():
        after_row = int(last_event_id)
    return StreamingResponse(
        _events(request, runner, lease, after_row, limit),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store"},
    )


async def _events(
    request: Request, runner: BenchControl, lease: Lease, after_row: int, limit: int
) -> AsyncIterator[str]:
    simulated = is_simulated(runner.configuration)
    shown = ""
    period = 0
    while not request.app.state.ending:
        found = runner.live(after_row, limit)
        if len(found.rows) or (found.restarted and found.last_row != after_row):
            after_row = found.last_row
            yield _event("rows", rows_of(found).model_dump_json(), after_row)
        status = status_of(runner.status(), simulated, lease_now(lease.current()))
        run, holder = status["run"], status["lease"]
        key = json.dumps(
            [status["state"], status["prompt"], run and run | {"progress": 0, "left_s": 0}, holder and holder["token"]]
        )
        if key != shown or period % STATUS_EVERY == 0:
            shown = key
            yield _event("status", json.dumps(status))
        period += 1
        await asyncio.sleep(PERIOD_S)


def _event(name: str, data: str, number: int | None = None) -> str:
    label = "" if number is None else f"id: {number}\n"
    return f"event: {name}\n{label}data: {data}\n\n"


@router.get("/now", summary="Status and new rows, once")
def now(runner: RunnerOf, lease: LeaseOf, after_row: AfterRow = -1, limit: MostRows = MOST_ROWS) -> LiveNow:
    """For programs that poll. Send `last_row` back as `after_row`."""
    simulated = is_simulated(runner.configuration)
    status = Status.model_validate(status_of(runner.status(), simulated, lease_now(lease.current())))
    return LiveNow(status=status, rows=rows_of(runner.live(after_row, limit)))
