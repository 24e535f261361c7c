"""Trials through the ordinary control loop as fast as they go, kept in memory: for joints that are only computed."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from types import TracebackType
from typing import Self

import numpy as np

from bench.config.channels import RECORDED, known_to_lab
from bench.config.configuration import BenchConfiguration
from bench.control.clock import VirtualClock
from bench.control.cycle import Procedure
from bench.control.drive_factory import Equipment
from bench.control.ending import StopRequest
from bench.control.limits import Guard
from bench.control.loop import joint_loop
from bench.control.servo import current_servo
from bench.errors import ExperimentError
from bench.experiments.kind import TrialPlan
from bench.json_types import Value
from bench.runs.session import CONDITION, Session
from compensator.lab.recordings.recording import Event, FloatArray, Recording


@dataclass
class Memory:
    """A sink that keeps the rows and events of one trial."""

    blocks: list[FloatArray] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    def append(self, rows: FloatArray, events: Sequence[tuple[float, str, str]] = ()) -> None:
        """Keep rows of shape (n, channels), and what happened while they came."""
        self.blocks.append(rows)
        self.events += [Event(*event) for event in events]

    def channels(self) -> dict[str, FloatArray]:
        """Every channel of `RECORDED`; all NaN where it was not measured."""
        return dict(zip(RECORDED, np.concatenate(self.blocks).T.copy(), strict=True))


class InMemoryBench:
    """An open drive, its control loop, and who hangs its loads. Closes the drive at its end."""

    def __init__(self, configuration: BenchConfiguration, equipment: Equipment) -> None:
        self._equipment, self._session = equipment, Session(None)
        period_s = configuration.control.period_s
        equipment.drive.open(period_s)
        servo = current_servo(configuration.rig)
        self._loop = joint_loop(equipment.drive, VirtualClock(), Guard(configuration.limits), period_s, servo)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._equipment.drive.close()

    def record(self, plan: TrialPlan, kind: str) -> Recording:
        """Run one trial. Errors as `run`."""
        _, kept = self.run(plan, plan.procedure())
        conditions = {**plan.conditions, CONDITION: self._session.seconds()}
        self._session.passed(self._loop.last_reading.time_s if self._loop.last_reading else 0.0)
        columns = kept.channels()
        measured = {name: columns[name] for name in known_to_lab(columns) if not np.isnan(columns[name]).all()}
        return Recording(plan.name, kind, conditions, measured, kept.events)

    def run(self, plan: TrialPlan, procedure: Procedure) -> tuple[dict[str, Value], Memory]:
        """Run one trial by its procedure, or by one round it: its results, and what was recorded.

        Raises:
            ExperimentError: it did not complete; why is told.
        """
        self._equipment.technician.hang_load(plan.load_kg, plan.balanced)
        kept = Memory()
        outcome = self._loop.run(procedure, kept, StopRequest())
        if outcome.outcome != "completed":
            raise ExperimentError(f"trial '{plan.name}': {outcome.outcome}: {outcome.reason}")
        return outcome.results, kept
