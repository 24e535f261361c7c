"""A wave with a band, given to the joint as a position or as a current: what chirp and multisine have in common."""

from collections.abc import Callable
from functools import partial
from typing import Any, Literal, Self, TypeVar

from pydantic import model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.errors import LimitError, quantity_message
from bench.experiments.kind import FinishedTrial, Parameters, TrialPlan, trial_plan
from bench.experiments.parts.refusal import refuse_load
from bench.experiments.parts.signal_play import Signal, play, refuse_signal
from bench.json_types import Value, numbers
from compensator.lab.recordings.recording import Condition, FloatArray
from drivers.contract import Mode

LEAST_SAMPLES = 8.0  # of a period of the highest frequency
RESTS_S = 2.0  # to the start and back, and to settle, roughly


class InjectionParameters(Parameters):
    """Parameters of a wave with a band."""

    load_kg: float = quantity(0.0, "kg", "Load on the arm", ge=0)
    balanced: bool = quantity(False, "", "Balance the load: same weight on the axis, no gravity torque")
    closed: Literal["position", "current"] = quantity(
        "position", "", "position: the servo follows the wave; current: the wave is the current, the joint is free"
    )
    amplitude_rad: float = quantity(0.05, "rad", "Largest angle, where a position is followed", gt=0)
    amplitude_a: float = quantity(0.2, "A", "Largest current, where a current is given", gt=0)
    low_hz: float = quantity(0.5, "Hz", "Lowest frequency", gt=0, le=1000)
    high_hz: float = quantity(5.0, "Hz", "Highest frequency", gt=0, le=1000)
    excursion_rad: float = quantity(
        0.8, "rad", "Farthest from angle 0 under a current; the joint is braked before", gt=0
    )
    repeats: int = quantity(1, "", "Number of trials", ge=1, le=100)

    @model_validator(mode="after")
    def _check_band(self) -> Self:
        if self.low_hz >= self.high_hz:
            raise ValueError(f"low_hz must be below high_hz, {self.high_hz:g} Hz")
        return self

    def signal(self, wave: FloatArray) -> Signal:
        """A wave within -1 .. 1 as it is played."""
        if self.closed == "position":
            return Signal("position_rad", self.amplitude_rad * wave)
        return Signal("current_a", self.amplitude_a * wave, self.excursion_rad)

    def modes(self) -> frozenset[Mode]:
        """That the drive has to close itself."""
        return frozenset({Mode.CURRENT}) if self.closed == "current" else frozenset()

    def held(self) -> dict[str, Condition]:
        """Conditions of its trials."""
        amplitude = {"amplitude_rad": self.amplitude_rad} if self.closed == "position" else {}
        amplitude |= {"amplitude_a": self.amplitude_a} if self.closed == "current" else {}
        return {"closed": self.closed, **amplitude, "low_hz": self.low_hz, "high_hz": self.high_hz}


ParametersT = TypeVar("ParametersT", bound=InjectionParameters)
Wave = Callable[[ParametersT, float], FloatArray]
"""Within -1 .. 1, one value per control period [s], shape (n,); it begins and ends at rest."""


def plan_injection(
    name: str, wave: Wave[ParametersT], parameters: ParametersT, configuration: BenchConfiguration
) -> list[TrialPlan]:
    """One trial per repeat."""
    signal = parameters.signal(wave(parameters, configuration.control.period_s))
    return plan_played(name, signal, parameters, configuration, **parameters.held())


def plan_played(
    name: str, signal: Signal, parameters: Any, configuration: BenchConfiguration, **held: Condition
) -> list[TrialPlan]:
    """The same of any signal, by `load_kg`, `balanced` and `repeats` of its parameters."""
    return [
        trial_plan(
            configuration,
            f"{name}-{repeat:02d}",
            partial(play, configuration, signal),
            parameters.load_kg,
            parameters.balanced,
            **held,
            repeat=repeat,
        )
        for repeat in range(1, parameters.repeats + 1)
    ]


def refuse_band(parameters: InjectionParameters, configuration: BenchConfiguration) -> None:
    """Raise `LimitError` for frequencies that the control loop cannot make; before a wave is made of them."""
    refuse_load("load_kg", parameters.load_kg, configuration)
    highest_hz = 1.0 / (LEAST_SAMPLES * configuration.control.period_s)
    if parameters.high_hz > highest_hz:
        allowed = f"at most {highest_hz:.4g}, {LEAST_SAMPLES:g} control cycles in a period"
        raise LimitError(quantity_message("high_hz", parameters.high_hz, allowed, "Hz"))


def refuse_injection(
    name: str, wave: Wave[ParametersT], parameters: ParametersT, configuration: BenchConfiguration
) -> None:
    """Raise `LimitError` for what the bench must not do."""
    refuse_band(parameters, configuration)
    refuse_signal(f"the {name}", parameters.signal(wave(parameters, configuration.control.period_s)), configuration)


def summarise_injection(_parameters: Any, trials: list[FinishedTrial]) -> dict[str, Value]:
    """Of all repeats."""
    done = [trial.results for trial in trials if "played_s" in trial.results]
    summary: dict[str, Value] = {"trials": len(done), "ended_early": sum(bool(one["ended_early"]) for one in done)}
    for name in ("played_s", "peak_speed_rad_s", "peak_current_a", "travel_rad", "rms_tracking_error_rad"):
        values = numbers(done, name)
        if values:
            summary[name] = min(values) if name == "played_s" else max(values)
    return summary
