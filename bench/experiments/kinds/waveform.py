"""A waveform of one's own, from a CSV: a position that is followed, or a current or duty that is given."""

from functools import cached_property
from typing import Any, Self

from pydantic import Field, model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.errors import LimitError, ParameterError
from bench.experiments.kind import ExperimentKind, Parameters, TrialPlan
from bench.experiments.parts.injection import RESTS_S, plan_played, summarise_injection
from bench.experiments.parts.refusal import refuse_load
from bench.experiments.parts.signal_play import MODES, PLAYED_RESULTS, Signal, refuse_signal
from bench.experiments.parts.waveform_csv import Waveform, read_waveform
from bench.json_types import Value
from drivers.contract import Mode

LARGEST_CSV = 2_000_000  # characters
FEWEST_CYCLES = 2


class WaveformParameters(Parameters):
    """Parameters of a waveform of one's own."""

    csv: str = Field(
        max_length=LARGEST_CSV,
        description="CSV with the columns t_s and one of position_rad, current_a, duty; a first line with their names",
        # `file`: on a command line the path of a file, whose name goes into the parameter named here
        json_schema_extra={"unit": "", "file": "source"},
    )
    source: str = quantity("waveform.csv", "", "Name of the file, for messages and the record", max_length=200)
    load_kg: float = quantity(0.0, "kg", "Load on the arm", ge=0)
    balanced: bool = quantity(False, "", "Balance the load: same weight on the axis, no gravity torque")
    excursion_rad: float = quantity(
        0.8, "rad", "Farthest from angle 0 under a current or duty; the joint is braked before", gt=0
    )
    repeats: int = quantity(1, "", "Number of trials", ge=1, le=100)

    @model_validator(mode="after")
    def _check_csv(self) -> Self:
        try:
            _ = self.waveform
        except ParameterError as error:
            raise ValueError(str(error)) from error
        return self

    @cached_property
    def waveform(self) -> Waveform:
        """What the CSV says."""
        return read_waveform(self.csv, self.source)

    def signal(self, period_s: float) -> Signal:
        """As it is played."""
        return Signal(self.waveform.quantity, self.waveform.resampled(period_s), self.excursion_rad)


def _plan(parameters: WaveformParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    signal = parameters.signal(configuration.control.period_s)
    return plan_played("waveform", signal, parameters, configuration, waveform=parameters.source)


def _refuse(parameters: WaveformParameters, configuration: BenchConfiguration) -> None:
    refuse_load("load_kg", parameters.load_kg, configuration)
    signal = parameters.signal(configuration.control.period_s)
    if len(signal.values) < FEWEST_CYCLES:
        period_s = configuration.control.period_s
        raise LimitError(f"{parameters.source} lasts less than one control period, {period_s:g} s; make it longer")
    refuse_signal(parameters.source, signal, configuration)


def _duration_s(parameters: WaveformParameters, _configuration: BenchConfiguration) -> float:
    return parameters.repeats * (float(parameters.waveform.time_s[-1]) + RESTS_S)


def _modes(parameters: WaveformParameters) -> frozenset[Mode]:
    mode = MODES.get(parameters.waveform.quantity)
    return frozenset() if mode is None else frozenset({mode})


def _summarise(parameters: WaveformParameters, trials: Any) -> dict[str, Value]:
    return {"quantity": parameters.waveform.quantity, **summarise_injection(parameters, trials)}


KIND = ExperimentKind(
    name="waveform",
    title="Waveform from a CSV",
    summary="Plays a waveform of your own: a position that the servo follows, or a current or duty that the motor is "
    "given. Speed and acceleration are checked against the limits before anything moves.",
    parameters=WaveformParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results=PLAYED_RESULTS,
    modes=_modes,
)
