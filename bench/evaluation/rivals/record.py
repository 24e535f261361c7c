"""One experiment through the ordinary loop, into memory, with what the arm truly leans on beside each row."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.control.clock import VirtualClock
from bench.control.cycle import Action, Procedure, Reading
from bench.control.drive_factory import make_equipment
from bench.control.ending import StopRequest
from bench.control.limits import Guard
from bench.control.loop import ControlLoop, joint_loop
from bench.control.servo import current_servo
from bench.drives.sim.kind import wall_torque_n_m
from bench.errors import ExperimentError
from bench.experiments.registry import find_kind, parse_parameters
from bench.runs.in_memory import Memory
from compensator.lab.recordings.recording import Condition, Event
from compensator.motion.kinetic_friction import FloatArray
from drivers.contract import Drive


@dataclass(frozen=True)
class Recorded:
    """One trial.

    Attributes:
        conditions, results, events: as a store would keep them.
        channels: name -> samples, all of one length; `wall_n_m` is the torque of a wall on the arm, which no drive
            measures.
    """

    conditions: dict[str, Condition]
    results: dict[str, Any]
    events: list[Event]
    channels: dict[str, FloatArray]


def record(configuration: BenchConfiguration, kind_name: str, **parameters: Any) -> list[Recorded]:
    """Run an experiment on the simulated bench as fast as it goes.

    Raises:
        BenchError: it is refused.
        ExperimentError: a trial did not complete.
    """
    kind = find_kind(kind_name)
    checked = parse_parameters(kind, parameters)
    kind.refuse(checked, configuration)
    drive, technician = make_equipment(configuration)
    period_s = configuration.control.period_s
    drive.open(period_s)
    try:
        servo = current_servo(configuration.rig)
        loop = joint_loop(drive, VirtualClock(), Guard(configuration.limits), period_s, servo)
        trials = []
        for plan in kind.plan(checked, configuration):
            technician.hang_load(plan.load_kg, plan.balanced)
            trials.append(_run(loop, drive, plan.procedure(), plan.name, plan.conditions))
        return trials
    finally:
        drive.close()


def _run(
    loop: ControlLoop[Action, Reading], drive: Drive, procedure: Procedure, name: str, conditions: dict[str, Condition]
) -> Recorded:
    memory = Memory()
    leant: list[float] = []
    outcome = loop.run(_witnessed(procedure, drive, leant), memory, StopRequest())
    if outcome.outcome != "completed":
        raise ExperimentError(f"trial '{name}': {outcome.outcome}: {outcome.reason}")
    return Recorded(conditions, outcome.results, memory.events, memory.channels() | {"wall_n_m": np.array(leant)})


def _witnessed(procedure: Procedure, drive: Drive, leant: list[float]) -> Procedure:
    """The procedure, with a look at the truth after every exchange."""
    try:
        action = next(procedure)
        while True:
            reading = yield action
            leant.append(wall_torque_n_m(drive))
            action = procedure.send(reading)
    except StopIteration as end:
        return end.value or {}
