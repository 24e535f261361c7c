"""What the bench is doing, as /bench and /live answer it."""

from typing import Any, Literal

from pydantic import BaseModel, Field

from bench.control.cycle import Reading
from bench.runs.runner import RunnerStatus
from bench.service.http.json_numbers import plain
from bench.service.routes.leases import LeaseNow

FAILED_POWER_OFF = ("power-off failed", "quick stop failed")  # notes of `bench.control.loop` in the reason of a run


class Run(BaseModel):
    """The experiment that runs, or the last one."""

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
    """The last sample, SI; null where the drive does not measure it."""

    time_s: float | None
    position_rad: float | None
    velocity_rad_s: float | None
    current_a: float | None
    duty: float | None
    supply_v: float | None
    temperature_c: float | None
    power: str = Field(
        description="of the power stage: disabled, enabled, quick_stop or fault; unknown after a failed power-off"
    )


class PromptNow(BaseModel):
    """What the person at the bench is asked to do; the power is off until it is answered."""

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


def status_of(found: RunnerStatus, simulated: bool, lease: LeaseNow | None) -> dict[str, Any]:
    """The fields of `Status`."""
    running = found.outcome == "running"
    run = None
    if found.kind:
        names = (
            "experiment_id", "kind", "outcome", "reason", "trial_index", "trial_count", "progress",
            "duration_s", "left_s", "pausing",
        )  # fmt: skip
        run = {name: getattr(found, name) for name in names} | {"power_off": None if running else _power_off(found)}
    reading = None if found.reading is None else _reading(found.reading)
    if reading is not None and not running:  # the last sample was taken before the power went
        reading["power"] = "disabled" if _power_off(found) == "confirmed" else "unknown"
    prompt = None if found.prompt is None else {"number": found.prompt.number, "sentence": found.prompt.sentence}
    state = "running" if running else "idle"
    holder = None if lease is None else lease.model_dump()
    return {"state": state, "simulated": simulated, "run": run, "reading": reading, "prompt": prompt, "lease": holder}


def _power_off(found: RunnerStatus) -> Literal["confirmed", "failed"]:
    """What the control loop noted of the power-off that ends every run."""
    return "failed" if any(note in found.reason for note in FAILED_POWER_OFF) else "confirmed"


def _reading(reading: Reading) -> dict[str, Any]:
    sample = reading.sample
    values = {
        "time_s": reading.time_s,
        "position_rad": sample.position_rad,
        "velocity_rad_s": reading.velocity_rad_s,
        "current_a": reading.current_a,
        "duty": sample.duty,
        "supply_v": sample.supply_v,
        "temperature_c": sample.temperature_c,
        "power": sample.status.name.lower(),
    }
    answer: dict[str, Any] = plain(values)
    return answer
