"""/lease: who has the bench. Whoever starts without one has it as long as the experiment runs."""

from typing import Annotated, cast

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from bench.runs.lease import DEFAULT_S, LONGEST_S, SHORTEST_S, Held, Lease
from bench.service.auth.access import Operator, allow_read, require_admin
from bench.service.auth.audit_trail import leave_out, note
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems

router = api_router("/lease", tags=["lease"])
Duration = Annotated[float, Field(ge=SHORTEST_S, le=LONGEST_S, description="until it ends, unless it is renewed [s]")]


async def _lease(request: Request) -> Lease:
    return cast(Lease, request.app.state.lease)


LeaseOf = Annotated[Lease, Depends(_lease)]


class LeaseNow(BaseModel):
    """Who has the bench."""

    model_config = ConfigDict(from_attributes=True)
    token: str = Field(description="name of the holder's token", examples=["ada"])
    holder: str = Field(description="as the holder wants to be called", examples=["Ada, room 12"])
    remaining_s: float | None = Field(
        description="until it ends, unless it is renewed; null: when the experiment that runs has ended"
    )


class LeaseState(BaseModel):
    """The lease of the bench."""

    lease: LeaseNow | None = Field(description="null where nobody has it")


class TakeLease(BaseModel):
    """For how long, and under which name."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"duration_s": 60, "holder": "Ada"}]})
    duration_s: Duration = DEFAULT_S
    holder: str = Field(default="", max_length=100, description="shown to the others; without it the token's name")
    take_over: bool = Field(default=False, description="take it from whoever has it; for admins, and on record")


class RenewLease(BaseModel):
    """For how long from now."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"duration_s": 60}]})
    duration_s: Duration = DEFAULT_S


async def require_lease(lease: LeaseOf, caller: Operator) -> None:
    """Dependency of every route that decides what the bench does: nobody else may hold it."""
    lease.require(caller.name)


def lease_now(found: Held | None) -> LeaseNow | None:
    """As it is answered."""
    return None if found is None else LeaseNow.model_validate(found)


@router.get("", summary="Who has the bench", dependencies=[Depends(allow_read)])
async def state(lease: LeaseOf) -> LeaseState:
    """The same stands in GET /bench and in every status."""
    return LeaseState(lease=lease_now(lease.current()))


@router.post("", status_code=201, summary="Take the bench", responses=problems(401, 403, 409, 422))
async def take(lease: LeaseOf, request: Request, caller: Operator, body: TakeLease | None = None) -> LeaseState:
    """While it lasts, others cannot start, continue or change the queue (409); everybody can stop.

    Renew it with PUT before it ends. An experiment that still runs when it ends goes on to its end.
    """
    wanted = body or TakeLease()
    before = lease.current()
    if wanted.take_over:
        require_admin.check(caller)
    found = lease.take(caller.name, wanted.holder, wanted.duration_s, wanted.take_over)
    taken_over = before is not None and before.token != caller.name
    note(request, f"took over the bench from {before.in_words()}" if before and taken_over else "took the bench")
    return LeaseState(lease=lease_now(found))


@router.put("", summary="Keep the bench", responses=problems(401, 403, 409, 422))
async def renew(lease: LeaseOf, request: Request, caller: Operator, body: RenewLease | None = None) -> LeaseState:
    """The heartbeat: the lease lasts `duration_s` from now. 409 where it has run out."""
    found = lease.renew(caller.name, (body or RenewLease()).duration_s)
    leave_out(request)
    return LeaseState(lease=lease_now(found))


@router.delete("", status_code=204, summary="Give the bench back", responses=problems(401, 403, 409))
async def release(lease: LeaseOf, request: Request, caller: Operator) -> None:
    """An experiment that runs goes on. Nothing happens where it is free already."""
    lease.release(caller.name)
    note(request, "gave the bench back")
