"""/bench: what stands there and what it is doing. /stop: stops it. /continue: the person at the bench is done.

/token: whether a token is the right one.
"""

import asyncio
from contextlib import suppress
from dataclasses import asdict

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field
from pydantic.fields import FieldInfo
from starlette.requests import ClientDisconnect

from bench import __version__
from bench.config.channels import CHANNELS
from bench.config.sections import Limits
from bench.control.drive_factory import is_simulated
from bench.json_types import Json
from bench.service.auth.access import Viewer, allow_read, require_viewer
from bench.service.auth.audit_trail import note
from bench.service.compute import at_bench
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.live.status import Status, status_of
from bench.service.routes.leases import LeaseOf, lease_now, require_lease
from bench.service.services import RunnerOf
from bench.service.stops import stop_all
from drivers.contract import Description

router = api_router(tags=["bench"])
NO_REASON = "stopped over REST"
LONGEST_REASON = 4096  # bytes of the body
REASON_WAIT_S = 0.05  # what a slow body is given; a whole one has arrived with its head


class DriveDescription(BaseModel):
    """Identity and capabilities of the drive."""

    device: str
    vendor: str
    product: str
    firmware: str
    serial: str
    modes: list[str]
    measured: list[str] = Field(description="quantities that the drive measures")
    resolution: dict[str, float] = Field(description="smallest step of a quantity, in its unit")
    max_rate_hz: float
    watchdog_s: float | None = Field(
        description="time without a command after which the drive stops by itself; null where nothing stops it"
    )
    watchdog: str = Field(description="how sure that is: 'proven', 'configured, not proven' or 'none'")
    notes: list[str] = Field(description="what was noticed of line and host, and what to do about it")


class Limit(BaseModel):
    """One limit of the bench."""

    name: str
    description: str
    value: float
    unit: str


class Bench(Status):
    """The bench: its drive, its limits, and what it is doing."""

    name: str
    software_version: str
    drive: DriveDescription | None = Field(description="null until the drive has been opened for the first time")
    limits: list[Limit]
    rig: Json


class RecordedChannel(BaseModel):
    """One channel of the recorded rows."""

    model_config = ConfigDict(from_attributes=True)
    name: str
    unit: str = Field(description="SI, angles in rad, temperatures in degC; 1 where there is none")
    label: str = Field(description="short, for plots")
    description: str
    plotted: bool = Field(description="whether a plot shows it unless asked otherwise")
    exported: bool = Field(description="whether recording sets, CSV and Parquet files hold it")


class RecordedChannels(BaseModel):
    """All of them."""

    channels: list[RecordedChannel]


class Stop(BaseModel):
    """Why it is stopped; kept with the record."""

    model_config = ConfigDict(extra="forbid")
    reason: str = Field(default="", max_length=200, examples=["cable is caught"])


class Stopped(BaseModel):
    """What the stop found."""

    detail: str
    was_running: bool


class Continue(BaseModel):
    """Which prompt is answered."""

    model_config = ConfigDict(extra="forbid")
    prompt: int = Field(ge=1, description="`number` of the prompt in the status", examples=[1])


class Accepted(BaseModel):
    """The answer is accepted."""

    accepted: bool = True


class Token(BaseModel):
    """Whose token it is, and what it is good for."""

    accepted: bool = True
    name: str = Field(examples=["ada"])
    role: str = Field(examples=["operator"], description="viewer, operator or admin")


@router.get("/bench", summary="Drive, limits and state", dependencies=[Depends(allow_read)])
def bench(runner: RunnerOf, lease: LeaseOf) -> Bench:
    """Reading this never moves anything."""
    found = runner.status()
    configuration = runner.configuration
    return Bench(
        **dict(status_of(found, is_simulated(configuration), lease_now(lease.current()))),
        name=configuration.name,
        software_version=__version__,
        drive=None if found.description is None else _drive(found.description),
        limits=_limits(configuration.limits),
        rig=configuration.rig.model_dump(exclude_none=True),
    )


@router.get("/channels", summary="What trials record", dependencies=[Depends(allow_read)])
def channels() -> RecordedChannels:
    """Name, unit and meaning of every channel, in the order of the columns. A trial names those that it has."""
    return RecordedChannels(channels=[RecordedChannel.model_validate(channel) for channel in CHANNELS.values()])


# async on purpose: it runs on the event loop itself and never waits for a free worker thread
@router.post("/stop/", include_in_schema=False, dependencies=[Depends(require_viewer)])  # else sent on, and not stopped
@router.post(
    "/stop",
    summary="Stop the joint and power it off",
    dependencies=[Depends(require_viewer)],
    responses=problems(401, 403),
    openapi_extra={"requestBody": {"content": {"application/json": {"schema": Stop.model_json_schema()}}}},
)
async def stop(runner: RunnerOf, request: Request) -> Stopped:
    """With any token, always, whoever has the bench. The control loop honours it within one cycle; it is on record.

    The queue is held, too: nothing more is started until somebody resumes. A commissioning or a calibration ends.

    The body may be left out. One that cannot be read stops the joint all the same.
    """
    found = runner.status()
    was_running = found.outcome == "running"
    reason = await _reason(request)
    stop_all(request.app, reason)
    note(request, f"stopped experiment {found.experiment_id}: {reason}" if was_running else "nothing was running")
    if was_running:
        return Stopped(detail="Stop accepted: the joint is being powered off.", was_running=True)
    # of a joint that something else moves, another service or a command, this one knows nothing
    return Stopped(detail="Nothing was running on this service.", was_running=False)


async def _reason(request: Request) -> str:
    """Why, as the body says; no body, however wrong or slow, may hold up a stop."""
    body = b""
    with suppress(ValueError, ClientDisconnect, TimeoutError):
        async with asyncio.timeout(REASON_WAIT_S):
            async for part in request.stream():
                body += part
                if len(body) > LONGEST_REASON:
                    break
        return Stop.model_validate_json(body).reason or NO_REASON
    return NO_REASON


@router.post(
    "/continue",
    summary="The person at the bench has done what was asked: the joint will move",
    dependencies=[Depends(require_lease)],
    responses=problems(401, 403, 409, 422),
)
async def go_on(runner: RunnerOf, request: Request, body: Continue) -> Accepted:
    """409 where that prompt is not the one that is open now: an answer that comes late moves nothing."""
    await at_bench(request, runner.answer, body.prompt)
    note(request, f"answered prompt {body.prompt} of experiment {runner.status().experiment_id}")
    return Accepted()


@router.get("/token", summary="Check a token", responses=problems(401))
async def token(caller: Viewer) -> Token:
    """Changes nothing; for programs that want to know before they need it."""
    return Token(name=caller.name, role=caller.role)


def _drive(found: Description) -> DriveDescription:
    modes, measured = sorted(mode.value for mode in found.modes), sorted(found.measured)
    return DriveDescription(**asdict(found) | {"modes": modes, "measured": measured, "watchdog": found.watchdog.value})


def _limits(limits: Limits) -> list[Limit]:
    fields = Limits.model_fields
    return [
        Limit(name=name, description=fields[name].description or "", value=value, unit=_unit(fields[name]))
        for name, value in limits
    ]


def _unit(field: FieldInfo) -> str:
    extra = field.json_schema_extra
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""
