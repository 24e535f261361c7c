"""/calibrations/run: measure friction curves where they are known least, paused and gone on with."""

import math
from functools import partial
from typing import Annotated, Literal

from fastapi import Depends, Request
from pydantic import BaseModel, ConfigDict, Field

from bench.errors import BusyError
from bench.json_types import Number
from bench.runs.calibrator import Calibrator
from bench.runs.sequential_calibration import Wish
from bench.service.auth.access import Operator, allow_read
from bench.service.auth.audit_trail import note
from bench.service.compute import at_bench
from bench.service.http.api_router import api_router
from bench.service.http.problems import problems
from bench.service.routes.leases import LeaseOf, require_lease
from bench.service.services import CalibratorOf, ConductorOf
from bench.service.stops import StopsOf

router = api_router("/calibrations/run", tags=["calibrations"], dependencies=[Depends(allow_read)])
steer = partial(router.post, dependencies=[Depends(require_lease)], responses=problems(401, 403, 409))
Load = Annotated[float, Field(ge=0, le=50)]
Duty = Annotated[float, Field(gt=0, le=1)]


class NewRun(BaseModel):
    """What a calibration is to reach."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"examples": [{"accuracy_a": 0.005, "budget_s": 240}]})
    accuracy_a: float = Field(
        default=0.005, ge=1e-5, le=10, description="half of the 95 % interval at which a curve is known well enough"
    )
    budget_s: float = Field(default=240.0, ge=30, le=36000, description="time of the joint for the curves")
    loads_kg: list[Load] = Field(
        default=[], max_length=10, description="empty: none and the heaviest, and between them if needed"
    )
    duties: list[Duty] = Field(default=[0.1, 0.2, 0.3], max_length=10, description="for the motor's constants")
    after: list[Annotated[int, Field(ge=1)]] = Field(
        default=[], max_length=100, description="experiments of a calibration that was broken off: they count along"
    )
    note: str = Field(default="", max_length=2000)


class Run(BaseModel):
    """How far the calibration is, or how the last one ended."""

    number: int | None = Field(description="of those of this service; null before the first", examples=[1])
    state: Literal["none", "running", "pausing", "paused", "fitting", "calibrated", "ended"] = Field(
        description="pausing: it stands still after the trial that runs", examples=["running"]
    )
    sentence: str = Field(description="what is measured, and why", examples=["50 g: known to 7.4 mA; 3 speeds next"])
    load_kg: float | None = Field(description="balanced on the arm; null while F_load is searched", examples=[0.05])
    half_width_a: Number = Field(
        description="half of the 95 % interval of its curve where it is known least; null before the first fit",
        examples=[0.0074],
    )
    accuracy_a: float | None = Field(description="that was asked for", examples=[0.005])
    progress: float = Field(ge=0, le=1, description="share of the longest time that it may take", examples=[0.4])
    spent_s: float = Field(description="of the joint's time, roughly", examples=[120.0])
    left_s: float = Field(description="of the joint's time, at most", examples=[180.0])
    experiment_ids: list[int] = Field(description="that have completed; they count along `after`", examples=[[1, 2]])
    calibration_id: int | None = Field(description="what came of it", examples=[None])
    reason: str = Field(description="why it ended without a calibration", examples=[""])


@router.get("", summary="How far a calibration is")
def state(calibrator: CalibratorOf) -> Run:
    """Progress, time left at most, and what is known so far."""
    return _represent(calibrator)


@router.post("", status_code=201, summary="Calibrate: the joint moves", responses=problems(401, 403, 404, 409, 422))
async def begin(
    calibrator: CalibratorOf,
    lease: LeaseOf,
    conductor: ConductorOf,
    caller: Operator,
    request: Request,
    stops: StopsOf,
    body: NewRun | None = None,
) -> Run:
    """F_load is searched, then curves are measured where they are known least, until each is known as asked.

    Every batch is an experiment of its own: whoever stops between two goes on later with `after`. What is fitted at the
    end is used as any calibration. 409 while an experiment or the queue runs.
    """
    wanted = body or NewRun()
    if conductor.running is not None:
        raise BusyError("the queue is running; pause it, or wait for its end")
    wish = Wish(tuple(wanted.loads_kg), wanted.accuracy_a, wanted.budget_s, tuple(wanted.duties))

    def started() -> int:
        with stops.starting():
            return calibrator.begin(wish, wanted.after, wanted.note)

    with lease.starting(caller.name):
        number = await at_bench(request, started)
    note(request, f"began calibration run {number}")
    return _represent(calibrator)


@steer("/pause", summary="Stand still after the trial that runs")
def pause(calibrator: CalibratorOf, request: Request) -> Run:
    """With the power off. 409 where none is under way."""
    _require(calibrator)
    calibrator.pause()
    note(request, "paused the calibration run")
    return _represent(calibrator)


@steer("/resume", summary="Go on: the joint moves")
def resume(calibrator: CalibratorOf, request: Request) -> Run:
    """409 where none is under way."""
    _require(calibrator)
    calibrator.resume()
    note(request, "went on with the calibration run")
    return _represent(calibrator)


def _require(calibrator: Calibrator) -> None:
    if not calibrator.is_under_way:
        raise BusyError("no calibration is under way; POST /calibrations/run begins one")


def _represent(calibrator: Calibrator) -> Run:
    task, doing, spent_s = calibrator.task, calibrator.state, calibrator.spent_s
    if task is None or task.calibration is None:
        return Run(
            number=None, state="none", sentence="", load_kg=None, half_width_a=math.nan, accuracy_a=None, progress=0.0,
            spent_s=0.0, left_s=0.0, experiment_ids=[], calibration_id=None, reason="",
        )  # fmt: skip
    longest_s = max(task.stand.longest_s, spent_s)
    return Run(
        number=task.number,
        state=doing,
        sentence=task.stand.sentence,
        load_kg=task.stand.load_kg,
        half_width_a=task.stand.half_width_a if math.isfinite(task.stand.half_width_a) else math.nan,
        accuracy_a=task.wish.accuracy_a,
        progress=1.0 if task.is_over or task.fitting else spent_s / longest_s,
        spent_s=spent_s,
        left_s=0.0 if task.is_over or task.fitting else longest_s - spent_s,
        experiment_ids=list(task.calibration.ids),
        calibration_id=task.calibration_id,
        reason=task.reason,
    )
