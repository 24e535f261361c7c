"""Runs a protocol of experiments through the ordinary control loop, and keeps the trials in memory."""

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.challenge.difficulty import Difficulty
from bench.clock import VirtualClock
from bench.configuration import BenchConfiguration
from bench.drive_factory import Equipment, make_equipment
from bench.errors import ExperimentError
from bench.experiments.kind import TrialPlan
from bench.experiments.registry import find_kind, parse_parameters
from bench.limits import Guard
from bench.loop import RECORDED, ControlLoop
from bench.servo import current_servo
from bench.stop_request import StopRequest
from compensator.lab.recording import Event, FloatArray, Recording

Protocol = list[tuple[str, dict[str, Any]]]
"""Experiments in order: kind, parameters."""


def protocol_of(difficulty: Difficulty, heaviest_kg: float, top_rad_s: float) -> Protocol:
    """What is recorded: identification motions under several loads, then steps with searches at rest."""
    loads_kg = [min(round(share * heaviest_kg, 4), heaviest_kg) for share in difficulty.loads]
    motions = {
        "loads_kg": loads_kg,
        "speed_rad_s": round(top_rad_s, 2),
        "duration_s": difficulty.duration_s,
        "repeats": difficulty.repeats,
    }
    protocol: Protocol = [("excitation", motions)]
    if difficulty.steps:
        steps = {"load_kg": loads_kg[-1], "repeats": difficulty.steps, "fastest_rad_s": round(top_rad_s, 2)}
        protocol.append(("steps", steps))
    return protocol


def record(configuration: BenchConfiguration, protocol: Protocol) -> list[Recording]:
    """Run every experiment of a protocol on the configuration's drive, as fast as the simulation goes.

    Raises:
        ExperimentError: a trial did not complete; nothing of the protocol is kept.
        LimitError, ConfigurationError, ParameterError: an experiment is refused.
    """
    equipment = make_equipment(configuration)
    equipment.drive.open(configuration.control.period_s)
    with closing(equipment.drive):
        loop = _loop(configuration, equipment)
        return [
            _run(plan, kind, loop, equipment)
            for kind, parameters in protocol
            for plan in _plans(kind, parameters, configuration)
        ]


def _plans(name: str, values: dict[str, Any], configuration: BenchConfiguration) -> Iterator[TrialPlan]:
    kind = find_kind(name)
    parameters = parse_parameters(kind, values)
    kind.refuse(parameters, configuration)
    yield from kind.plan(parameters, configuration)


def _loop(configuration: BenchConfiguration, equipment: Equipment) -> ControlLoop:
    guard = Guard(configuration.limits)
    servo = current_servo(configuration.rig)
    return ControlLoop(equipment.drive, VirtualClock(), guard, configuration.control.period_s, servo)


def _run(plan: TrialPlan, kind: str, loop: ControlLoop, equipment: Equipment) -> Recording:
    equipment.technician.hang_load(plan.load_kg, plan.balanced)
    kept = _Memory()
    outcome = loop.run(plan.procedure(), kept, StopRequest())
    if outcome.outcome != "completed":
        raise ExperimentError(f"trial '{plan.name}': {outcome.outcome}: {outcome.reason}")
    return Recording(plan.name, kind, plan.conditions, kept.channels(), kept.events)


@dataclass
class _Memory:
    """Rows and events of one trial."""

    blocks: list[NDArray[np.float64]] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)

    def append(self, rows: NDArray[np.float64]) -> None:
        self.blocks.append(rows)

    def event(self, time_s: float, name: str, detail: str) -> None:
        self.events.append(Event(time_s, name, detail))

    def channels(self) -> dict[str, FloatArray]:
        """The channels that were measured."""
        columns = np.concatenate(self.blocks).T.copy()
        return {name: column for name, column in zip(RECORDED, columns, strict=True) if not np.isnan(column).all()}
