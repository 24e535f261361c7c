"""One experiment through the ordinary loop, into memory, with what the arm truly leans on beside each row."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.control.cycle import Procedure
from bench.control.drive_factory import make_equipment
from bench.drives.sim.kind import wall_torque_n_m
from bench.evaluation.challenge.session import plans_of
from bench.runs.in_memory import InMemoryBench
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
    equipment = make_equipment(configuration)
    trials = []
    with InMemoryBench(configuration, equipment) as bench:
        for plan in plans_of(kind_name, parameters, configuration):
            leant: list[float] = []
            results, kept = bench.run(plan, _witnessed(plan.procedure(), equipment.drive, leant))
            channels = kept.channels() | {"wall_n_m": np.array(leant)}
            trials.append(Recorded(plan.conditions, results, kept.events, channels))
    return trials


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
