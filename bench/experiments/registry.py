"""All kinds of experiment, by name."""

from importlib import import_module

from pydantic import ValidationError

from bench.config.validation import problems
from bench.errors import ParameterError, UnknownKindError
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan
from bench.json_types import Value, Values

# modules of `bench.experiments.kinds`, in the order in which their kinds are shown
_SHOWN = (
    "steps",
    "load_sweep",
    "speed_sweep",
    "steady_speeds",
    "sinusoid",
    "excitation",
    "breakaway_ramps",
    "reversals",
    "chirp",
    "multisine",
    "coast_down",
    "hold_and_soak",
    "waveform",
    "teleoperation",
    "commissioning",
    "identification",
)


def _kind_of(module: str) -> ExperimentKind:
    kind: ExperimentKind = import_module(f"bench.experiments.kinds.{module}").KIND
    return kind


KINDS: dict[str, ExperimentKind] = {kind.name: kind for kind in map(_kind_of, _SHOWN)}
_OF_DOCTOR = {kind.name: kind for kind in [_kind_of("homing")]}  # `doctor --home` runs it, nobody chooses it

__all__ = [
    "KINDS", "ExperimentKind", "FinishedTrial", "Parameters", "TrialPlan", "find_kind", "parse_parameters",
    "whole_parameters",
]  # fmt: skip


def find_kind(name: str) -> ExperimentKind:
    """The kind of that name.

    Raises:
        UnknownKindError: naming those that exist.
    """
    known = KINDS | _OF_DOCTOR
    if name not in known:
        raise UnknownKindError(f"there is no experiment '{name}'; known are {', '.join(KINDS)}")
    return known[name]


def parse_parameters(kind: ExperimentKind, values: Values) -> Parameters:
    """Parameters from what a user gave; what is left out has its default.

    Raises:
        ParameterError: naming each parameter, its value, what is allowed and the unit.
    """
    try:
        return kind.parameters.model_validate(values)
    except ValidationError as error:
        raise ParameterError(f"{kind.name}: " + "; ".join(problems(error, model=kind.parameters))) from error


def whole_parameters(kind: str, values: Values) -> dict[str, Value]:
    """Also those that were left out, as they are kept with an experiment.

    Raises:
        UnknownKindError, ParameterError
    """
    return parse_parameters(find_kind(kind), values).model_dump(mode="json")
