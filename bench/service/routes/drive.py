"""/drive: what the drives say of themselves, and the clearing of a fault that they hold on to. No power is switched on.

Reading needs the drives to be opened, so it is a POST as well: nothing connects to a drive on GET.
"""

from functools import partial

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from bench.control import drive_faults
from bench.control.drive_faults import faults_in_words
from bench.service.auth.audit_trail import note
from bench.service.compute import at_bench
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.routes.leases import require_lease
from bench.service.services import RunnerOf

router = api_router("/drive", tags=["bench"])


class DriveState(BaseModel):
    """One drive."""

    model_config = ConfigDict(from_attributes=True)
    joint: str = Field(description="joint; or slave and master", examples=["joint"])
    device: str = Field(examples=["/dev/ttyUSB0 unit 1"])
    state: str = Field(description="of the power stage; empty where the drive has no word for it", examples=["fault"])
    fault: str = Field(description="in words; empty where there is none", examples=["over-current"])
    torque_off: str = Field(
        "",
        description="what says that safe torque off is active: no power, and no fault of the joint; empty where "
        "nothing does",
        examples=["its circuit is open"],
    )


class DriveStates(BaseModel):
    """Every drive of the bench."""

    drives: list[DriveState]
    fault: str = Field(description="all their faults, in words; empty where there is none", examples=["over-current"])


class ClearFault(BaseModel):
    """Which fault a person has seen, and wants cleared."""

    model_config = ConfigDict(extra="forbid")
    fault: str = Field(description="`fault` as POST /drive/state told it", max_length=2000, examples=["over-current"])


ask = partial(router.post, dependencies=[Depends(require_lease)], responses=problems(401, 403, 409, 422, 502))


@ask("/state", summary="What the drives say of themselves")
async def state(runner: RunnerOf, request: Request) -> DriveStates:
    """Connects to them, with the power off; 409 while an experiment runs."""
    return _represent(await at_bench(request, runner.read_drives))


@ask("/clear-fault", summary="Clear a fault that has been seen")
async def clear_fault(runner: RunnerOf, request: Request, body: ClearFault) -> DriveStates:
    """The power stays off. 409 where the fault is another one by now, 502 where its cause is still there."""
    found = await at_bench(request, runner.clear_faults, body.fault)
    note(request, f"cleared the fault '{body.fault}'" if body.fault else "there was no fault to clear")
    return _represent(found)


def _represent(states: tuple[drive_faults.DriveState, ...]) -> DriveStates:
    return DriveStates(drives=[DriveState.model_validate(state) for state in states], fault=faults_in_words(states))
