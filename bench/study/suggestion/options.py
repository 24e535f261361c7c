"""Trials that the bench could run next: one of each kind, load and speed, inside its limits."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from pydantic import JsonValue

from bench.config.configuration import BenchConfiguration
from bench.control import commissioned
from bench.errors import BenchError
from bench.experiments.kind import ExperimentKind, Parameters, TrialPlan
from bench.experiments.kinds.excitation import OVERSHOOT_RAD
from bench.experiments.parts.waveforms import WAVEFORMS
from bench.experiments.registry import KINDS, parse_parameters
from bench.json_types import Json, as_option

LOAD_SHARES = (0.0, 0.5, 1.0)  # of the heaviest load
SPEED_SHARES = (0.15, 0.6)  # of the speed limit
RATES_A_S = (0.03, 0.1, 0.3, 1.0)  # of breakaway ramps: quicker ones show the servo
DWELLS_S = (0.2, 2.0, 20.0)  # at rest before each
LONGEST_S = 90.0
HANG_S = 30.0  # that a person takes to change the load


@dataclass(frozen=True)
class Choice:
    """An experiment that could be started.

    Attributes:
        kind: of it; parameters: those that differ from the defaults.
        plans: its trials.
        duration_s: of bench time, the hanging of loads included.
    """

    kind: str
    parameters: Json
    plans: tuple[TrialPlan, ...]
    duration_s: float

    @property
    def name(self) -> str:
        """Kind and parameters in one line."""
        return " ".join([self.kind, *(f"{name}={as_option(value)}" for name, value in self.parameters.items())])


def choices(configuration: BenchConfiguration, hung_by_hand: bool, from_rest: bool = False) -> list[Choice]:
    """Every experiment that the limits allow, of one or two trials each.

    Args:
        configuration: of the bench.
        hung_by_hand: a person hangs the loads, which takes time.
        from_rest: what is to be told apart shows at starts from rest: ramps of each rate after each rest, and no other.
    """
    found = []
    for kind in KINDS.values():
        if kind.name == commissioned.KIND or (from_rest and kind.name not in _FROM_REST):
            continue
        values_of = (_FROM_REST if from_rest else _VALUES).get(kind.name, _plainly)
        for values in values_of(kind, configuration):
            choice = _choice(kind, values, configuration, HANG_S if hung_by_hand else 0.0)
            if choice is not None:
                found.append(choice)
    return found


def _choice(kind: ExperimentKind, values: Json, configuration: BenchConfiguration, hang_s: float) -> Choice | None:
    """The choice; None where the bench refuses it, or it takes long."""
    try:
        parameters: Parameters = parse_parameters(kind, values)
        kind.refuse(parameters, configuration)
        plans = tuple(kind.plan(parameters, configuration))
        duration_s = kind.duration_s(parameters, configuration)
    except BenchError:
        return None
    if duration_s > LONGEST_S or not plans:
        return None
    return Choice(kind.name, values, plans, duration_s + hang_s)


Values = Iterator[Json]


def _excitation(_: ExperimentKind, configuration: BenchConfiguration) -> Values:
    limits = configuration.limits
    room_rad = min(-limits.position_min_rad, limits.position_max_rad) - 1.01 * OVERSHOOT_RAD
    amplitude_rad = round(min(1.6, room_rad), 3)
    for load_kg in _loads(configuration):
        for speed_rad_s in _speeds(configuration):
            for waveform in WAVEFORMS:
                yield {
                    "waveforms": [waveform], "loads_kg": [load_kg], "speed_rad_s": speed_rad_s,
                    "amplitude_rad": amplitude_rad, "repeats": 1,
                }  # fmt: skip


def _speed_sweep(_: ExperimentKind, configuration: BenchConfiguration) -> Values:
    for load_kg in _loads(configuration):
        for speed_rad_s in (0.02, 0.08, *_speeds(configuration)):
            yield {
                "loads_kg": [load_kg], "currents_a": [], "duties": [], "speeds_rad_s": [speed_rad_s],
                "top_speed_rad_s": max(_speeds(configuration)),
            }  # fmt: skip


def _steps(_: ExperimentKind, configuration: BenchConfiguration) -> Values:
    fastest_rad_s = max(_speeds(configuration))
    for load_kg in _loads(configuration):
        yield {"load_kg": load_kg, "repeats": 2, "slowest_rad_s": 0.2 * fastest_rad_s, "fastest_rad_s": fastest_rad_s}


def _breakaway_ramps(_: ExperimentKind, configuration: BenchConfiguration) -> Values:
    for load_kg in _loads(configuration):
        for rate_a_s in RATES_A_S:
            for dwell_s in DWELLS_S:
                yield {"load_kg": load_kg, "rates_a_s": [rate_a_s], "dwells_s": [dwell_s]}


def _plainly(kind: ExperimentKind, configuration: BenchConfiguration) -> Values:
    """Any other kind at its defaults, with each load, once."""
    fields = kind.parameters.model_fields
    once: dict[str, JsonValue] = {"repeats": 1} if "repeats" in fields else {}
    if "load_kg" in fields:
        yield from ({"load_kg": load_kg, **once} for load_kg in _loads(configuration))
    elif "loads_kg" in fields:
        for load_kg in _loads(configuration):
            loads: list[JsonValue] = [load_kg]
            yield {"loads_kg": loads, **once}
    else:
        yield once


_VALUES: dict[str, Callable[[ExperimentKind, BenchConfiguration], Values]] = {
    "excitation": _excitation,
    "speed-sweep": _speed_sweep,
    "steps": _steps,
}
"""What is tried of each kind; kinds that are not here are tried as they are."""
_FROM_REST: dict[str, Callable[[ExperimentKind, BenchConfiguration], Values]] = {"breakaway-ramps": _breakaway_ramps}
"""The same where starts from rest are what tells."""


def _loads(configuration: BenchConfiguration) -> list[float]:
    heaviest_kg = configuration.limits.load_kg
    return sorted(
        {round(share * heaviest_kg, 4) for share in LOAD_SHARES if round(share * heaviest_kg, 4) <= heaviest_kg}
    )


def _speeds(configuration: BenchConfiguration) -> list[float]:
    return [float(f"{share * configuration.limits.speed_rad_s:.2g}") for share in SPEED_SHARES]
