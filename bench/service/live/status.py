"""What the bench is doing, as /bench and /live answer it."""

from math import isfinite
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from bench.control.cycle import Reading
from bench.json_types import Number
from bench.runs.bench_control import RunnerStatus
from bench.runs.live import LiveRows
from bench.service.http.downloads import column
from bench.service.routes.leases import LeaseNow


class Rows(BaseModel):
    """Rows since `after_row`. A quantity that was not measured is null."""

    channels: list[str]
    rows: list[list[float | None]]
    last_row: int = Field(description="send it as `after_row` next time")
    restarted: bool = Field(description="True where rows before these belong to something else or are gone")
    trial_id: int | None = Field(description="of these rows; null where that is not known")


def rows_of(found: LiveRows) -> Rows:
    """Rows for JSON."""
    return Rows(
        channels=list(found.channels),
        rows=[column(row) for row in found.rows],
        last_row=found.last_row,
        restarted=found.restarted,
        trial_id=found.trial_id,
    )


class Run(BaseModel):
    """The experiment that runs, or the last one."""

    model_config = ConfigDict(from_attributes=True)
    experiment_id: int | None
    kind: str
    outcome: str = Field(description="running, completed, stopped, tripped, failed, interrupted or refused")
    reason: str = Field(description="why it ended")
    trial_index: int = Field(description="trial that runs, from 0")
    trial_count: int
    progress: float = Field(ge=0, le=1, description="share of the experiment that is done, 0..1")
    duration_s: float = Field(description="estimate of the whole, in the joint's time; a simulated one may be faster")
    left_s: float = Field(description="what is left of it")
    pausing: str = Field(description="asked: it stands still after the trial that runs; paused: it does; else empty")
    power_off: Literal["confirmed", "failed"] | None = Field(
        description="whether the drive took its power off at the end; null while it runs"
    )


class ReadingNow(BaseModel):
    """The last sample, SI; null where the drive does not measure it. After a run it is that of its last cycle."""

    time_s: Number
    position_rad: Number
    velocity_rad_s: Number
    current_a: Number = Field(description="measured, else by eq. (3) of the paper; see `current_measured`")
    current_measured: bool = Field(description="false where `current_a` is no measurement, or is null")
    current_estimate_a: Number = Field(description="from duty, speed and supply by eq. (3); null where not known")
    duty: Number
    supply_v: Number
    temperature_c: Number
    power: str = Field(
        description="of the power stage: disabled, enabled, quick_stop or fault; unknown after a failed power-off"
    )


class PromptNow(BaseModel):
    """What the person at the bench is asked to do; the power is off until it is answered."""

    model_config = ConfigDict(from_attributes=True)
    number: int = Field(description="send it with POST /continue")
    sentence: str = Field(examples=["Hang 50 g at the tip of the arm, and stand clear."])


class Status(BaseModel):
    """State of the bench."""

    state: Literal["idle", "running"]
    simulated: bool = Field(description="True where no hardware moves")
    run: Run | None = Field(description="null before the first experiment")
    reading: ReadingNow | None
    prompt: PromptNow | None = Field(description="null where nobody is waited for")
    lease: LeaseNow | None = Field(description="who has the bench; null where nobody has")


def status_of(found: RunnerStatus, simulated: bool, lease: LeaseNow | None) -> Status:
    """State of the bench, from that of its runner."""
    return Status(
        state="running" if found.outcome == "running" else "idle",
        simulated=simulated,
        run=Run.model_validate(found) if found.kind else None,
        reading=None if found.reading is None else _reading(found.reading, _power(found, found.reading)),
        prompt=None if found.prompt is None else PromptNow.model_validate(found.prompt),
        lease=lease,
    )


def _power(found: RunnerStatus, reading: Reading) -> str:
    """State of the power stage: where a run has ended or stands still, the last sample is of before the power went."""
    if found.outcome == "running" and (found.pausing == "paused" or found.prompt is not None):
        return "disabled"
    if found.outcome == "running":
        return reading.sample.status.name.lower()
    return "disabled" if found.power_off == "confirmed" else "unknown"


def _reading(reading: Reading, power: str) -> ReadingNow:
    sample = reading.sample
    return ReadingNow(
        time_s=reading.time_s,
        position_rad=sample.position_rad,
        velocity_rad_s=reading.velocity_rad_s,
        current_a=reading.current_a,
        current_measured=isfinite(sample.current_a),
        current_estimate_a=reading.current_estimate_a,
        duty=sample.duty,
        supply_v=sample.supply_v,
        temperature_c=sample.temperature_c,
        power=power,
    )
