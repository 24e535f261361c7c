"""All kinds of experiment, by name."""

from pydantic import ValidationError

from bench.config.validation import problems
from bench.errors import ParameterError, UnknownKindError
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan
from bench.experiments.kinds import (
    breakaway_ramps,
    chirp,
    coast_down,
    commissioning,
    excitation,
    hold_and_soak,
    homing,
    identification,
    load_sweep,
    multisine,
    reversals,
    sinusoid,
    speed_sweep,
    steady_speeds,
    steps,
    teleoperation,
    waveform,
)
from bench.json_types import Values

KINDS: dict[str, ExperimentKind] = {
    kind.name: kind
    for kind in (
        steps.KIND,
        load_sweep.KIND,
        speed_sweep.KIND,
        steady_speeds.KIND,
        sinusoid.KIND,
        excitation.KIND,
        breakaway_ramps.KIND,
        reversals.KIND,
        chirp.KIND,
        multisine.KIND,
        coast_down.KIND,
        hold_and_soak.KIND,
        waveform.KIND,
        teleoperation.KIND,
        commissioning.KIND,
        identification.KIND,
    )
}

_OF_DOCTOR = {homing.KIND.name: homing.KIND}  # no experiment that one chooses: `doctor --home` runs it

__all__ = ["KINDS", "ExperimentKind", "FinishedTrial", "Parameters", "TrialPlan", "find_kind", "parse_parameters"]


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
