"""What every kind of experiment offers: parameters, a plan of trials, a refusal before motion, a summary."""

import sys
from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import BaseModel, ConfigDict, field_validator

from bench.config.configuration import BenchConfiguration
from bench.control.ending import OutcomeName
from bench.json_types import Value
from compensator.lab.recordings.recording import Condition
from drivers.contract import Mode

AnyProcedure = Generator[Any, Any, dict[str, Value]]
"""Of one joint (`bench.control.cycle.Procedure`), or of a pair (`bench.control.pairs.pair.PairProcedure`)."""


RESULTS_OF_ALL = {"cycles": "control cycles of the trial", "overruns": "of these, those that ended late"}
"""Results that each trial has, whatever its kind."""


MOST_OF_A_LIST = 200
SMALLEST = sys.float_info.min  # of a number that is not 0: what is divided by less is beyond all numbers


class Parameters(BaseModel):
    """Parameters of an experiment. One definition for REST, form and command line."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @field_validator("*")
    @classmethod
    def _can_be_planned(cls, value: Any) -> Any:
        if isinstance(value, tuple) and len(value) > MOST_OF_A_LIST:
            raise ValueError(f"has {len(value)} values; allowed are {MOST_OF_A_LIST}. Run several experiments")
        if isinstance(value, float) and 0.0 < abs(value) < SMALLEST:
            raise ValueError(f"allowed is 0, or at least {SMALLEST:g} in size")
        return value


@dataclass(frozen=True, slots=True)
class TrialPlan:
    """One trial to come.

    Attributes:
        name: unique within its experiment.
        conditions: what is held constant; the keys carry units.
        procedure: makes a fresh procedure.
        load_kg, balanced: what has to hang on the arm; of a pair, on the slave's.
        wall_rad: where a wall stands in the way of a pair's slave; None: nowhere. Of others it means nothing.
    """

    name: str
    conditions: dict[str, Condition]
    procedure: Callable[[], AnyProcedure]
    load_kg: float
    balanced: bool = False
    wall_rad: float | None = None


@dataclass(frozen=True, slots=True)
class FinishedTrial:
    """One trial that was run."""

    name: str
    conditions: dict[str, Condition]
    outcome: OutcomeName
    results: dict[str, Value]


def any_drive(_parameters: Any) -> frozenset[Mode]:
    """No mode of its own is needed."""
    return frozenset()


def a_current(_parameters: Any) -> frozenset[Mode]:
    """Currents are asked for: of a drive with that mode, or by eq. (3) of one with a duty."""
    return frozenset({Mode.CURRENT})


def as_asked(parameters: Any, _modes: frozenset[Mode]) -> Any:
    """The parameters as they are."""
    return parameters


def results_of_the_trial(_parameters: Any, trials: list[FinishedTrial]) -> dict[str, Value]:
    """The results of a kind that makes one trial."""
    return dict(trials[0].results) if trials else {}


@dataclass(frozen=True, slots=True)
class ExperimentKind:
    """One kind of experiment.

    Attributes:
        name: as typed ("load-sweep").
        title: as shown ("Load sweep").
        summary: one or two sentences: what is done, and what it tells.
        parameters: the pydantic model of its parameters.
        plan: the trials, in order.
        refuse: raises `LimitError` or `ConfigurationError` before motion when the bench must not or cannot do it.
        duration_s: estimate of the time it takes in real time [s].
        summarise: results of the whole from those of its trials; JSON-able, units in the names.
        modes: that the drive has to close itself. Position is done without; a current by drives with a duty, too.
        adapt: the parameters as a drive of certain modes allows; raises nothing.
        results: what the results of each trial are, by name; the reference prints them.
        pair: it moves a master and a slave; its procedures are those of `bench.control.pairs.pair`.
    """

    name: str
    title: str
    summary: str
    parameters: type[Parameters]
    plan: Callable[[Any, BenchConfiguration], list[TrialPlan]]
    refuse: Callable[[Any, BenchConfiguration], None]
    duration_s: Callable[[Any, BenchConfiguration], float]
    summarise: Callable[[Any, list[FinishedTrial]], dict[str, Value]]
    modes: Callable[[Any], frozenset[Mode]] = any_drive
    adapt: Callable[[Any, frozenset[Mode]], Any] = as_asked
    results: Mapping[str, str] = field(default_factory=dict)
    pair: bool = False


def trial_plan(
    configuration: BenchConfiguration,
    name: str,
    procedure: Callable[[], AnyProcedure],
    load_kg: float,
    balanced: bool = False,
    **held: Condition,
) -> TrialPlan:
    """A trial to come. Its conditions: load, balance, what else is held, and the arm's length where it is known."""
    length_m = configuration.rig.arm.length_m
    known: dict[str, Condition] = {} if length_m is None else {"arm_m": length_m}
    return TrialPlan(name, {"load_kg": load_kg, "balanced": balanced, **held, **known}, procedure, load_kg, balanced)
