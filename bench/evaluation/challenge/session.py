"""Runs a protocol of experiments through the ordinary control loop, and keeps the trials in memory."""

from collections.abc import Iterator

from bench.config.configuration import BenchConfiguration
from bench.control.drive_factory import make_equipment
from bench.evaluation.challenge.difficulty import Difficulty
from bench.experiments.kind import TrialPlan
from bench.experiments.registry import find_kind, parse_parameters
from bench.json_types import Value, Values
from bench.runs.in_memory import InMemoryBench
from compensator.lab.recordings.recording import Recording

Protocol = list[tuple[str, Values]]
"""Experiments in order: kind, parameters."""


def protocol_of(difficulty: Difficulty, heaviest_kg: float, top_rad_s: float) -> Protocol:
    """What is recorded: identification motions under several loads, then steps with searches at rest."""
    loads_kg = [min(round(share * heaviest_kg, 4), heaviest_kg) for share in difficulty.loads]
    motions: dict[str, Value] = {
        "loads_kg": loads_kg,
        "speed_rad_s": round(top_rad_s, 2),
        "duration_s": difficulty.duration_s,
        "repeats": difficulty.repeats,
    }
    protocol: Protocol = [("excitation", motions)]
    if difficulty.steps:
        steps: dict[str, Value] = {
            "load_kg": loads_kg[-1],
            "repeats": difficulty.steps,
            "fastest_rad_s": round(top_rad_s, 2),
        }
        protocol.append(("steps", steps))
    return protocol


def record(configuration: BenchConfiguration, protocol: Protocol) -> list[Recording]:
    """Run every experiment of a protocol on the configuration's drive, as fast as the simulation goes.

    Raises:
        ExperimentError: a trial did not complete; nothing of the protocol is kept.
        LimitError, ConfigurationError, ParameterError: an experiment is refused.
    """
    with InMemoryBench(configuration, make_equipment(configuration)) as bench:
        return [
            bench.record(plan, kind)
            for kind, parameters in protocol
            for plan in plans_of(kind, parameters, configuration)
        ]


def plans_of(name: str, values: Values, configuration: BenchConfiguration) -> Iterator[TrialPlan]:
    """The trials of an experiment, which the bench does not refuse. Errors as `ExperimentKind.refuse`."""
    kind = find_kind(name)
    parameters = parse_parameters(kind, values)
    kind.refuse(parameters, configuration)
    yield from kind.plan(parameters, configuration)
