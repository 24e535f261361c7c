"""Motion that the model lab can learn from: designed waveforms under several loads, repeated."""

from functools import partial
from itertools import product
from typing import Annotated

import numpy as np
from pydantic import Field, field_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.control.cycle import Procedure
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, trial_plan
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.profile import SetPoint
from bench.experiments.parts.refusal import refuse_angles, refuse_currents, refuse_load, refuse_many, refuse_speed
from bench.experiments.parts.waveforms import WAVEFORMS, sampled
from bench.json_types import Value, numbers

OVERSHOOT_RAD = 0.1  # of the servo, at most
REST_S = 2.0  # to go to the start and back, roughly


class ExcitationParameters(Parameters):
    """Parameters of an identification run."""

    loads_kg: tuple[Annotated[float, Field(ge=0)], ...] = quantity(
        (0.0, 0.05, 0.1), "kg", "Loads, in the order they are hung", min_length=1
    )
    waveforms: tuple[str, ...] = quantity(tuple(WAVEFORMS), "", f"Motions, of {', '.join(WAVEFORMS)}", min_length=1)
    amplitude_rad: float = quantity(1.6, "rad", "Largest angle, either way", gt=0)
    speed_rad_s: float = quantity(4.0, "rad/s", "Highest speed of the set point", gt=0)
    duration_s: float = quantity(8.0, "s", "Length of one motion", ge=2, le=600)
    repeats: int = quantity(2, "", "Trials of each motion under each load", ge=1, le=100)
    balanced: bool = quantity(False, "", "Balance the load: same weight on the axis, no gravity torque")

    @field_validator("waveforms")
    @classmethod
    def _check_waveforms(cls, names: tuple[str, ...]) -> tuple[str, ...]:
        for name in names:
            if name not in WAVEFORMS:
                raise ValueError(f"there is no motion '{name}'; known are {', '.join(WAVEFORMS)}")
        return names


def excite(configuration: BenchConfiguration, waveform: str, parameters: ExcitationParameters) -> Procedure:
    """The procedure: from rest at angle 0 through the waveform and back to rest.

    Results:
        rms_tracking_error_rad: how closely the joint followed.
        peak_speed_rad_s: of the joint.
        peak_current_a: of the motor.
    """
    joint = Joint(configuration)
    period_s = configuration.control.period_s
    set_points = sampled(waveform, parameters.duration_s, period_s, parameters.amplitude_rad, parameters.speed_rad_s)
    yield from joint.wake()
    yield from joint.rest_at(0.0)
    readings = yield from joint.follow(SetPoint(*point) for point in set_points.tolist())
    yield from joint.settle(0.0)
    measured = np.array([(r.sample.position_rad, r.velocity_rad_s, r.current_a) for r in readings])
    return {
        "rms_tracking_error_rad": float(np.sqrt(np.mean((measured[:, 0] - set_points[:, 0]) ** 2))),
        "peak_speed_rad_s": float(np.max(np.abs(measured[:, 1]))),
        "peak_current_a": float(np.max(np.abs(measured[:, 2]))),
    }


def _plan(parameters: ExcitationParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    choices = product(enumerate(parameters.loads_kg, 1), range(1, parameters.repeats + 1), parameters.waveforms)
    return [
        trial_plan(
            configuration,
            f"{waveform}-load-{number:02d}-{repeat:02d}",
            partial(excite, configuration, waveform, parameters),
            load_kg,
            parameters.balanced,
            waveform=waveform,
            repeat=repeat,
        )
        for (number, load_kg), repeat, waveform in choices
    ]


def _refuse(parameters: ExcitationParameters, configuration: BenchConfiguration) -> None:
    refuse_many(_trials(parameters), "loads_kg, waveforms and repeats")
    for load_kg in parameters.loads_kg:
        refuse_load("a load of loads_kg", load_kg, configuration)
    reach_rad = parameters.amplitude_rad
    refuse_angles("amplitude_rad", [-reach_rad, reach_rad], OVERSHOOT_RAD, configuration)
    refuse_speed("speed_rad_s", parameters.speed_rad_s, configuration)
    refuse_currents(configuration)


def _trials(parameters: ExcitationParameters) -> int:
    return len(parameters.loads_kg) * len(parameters.waveforms) * parameters.repeats


def _duration_s(parameters: ExcitationParameters, _configuration: BenchConfiguration) -> float:
    return _trials(parameters) * (parameters.duration_s + REST_S)


def _summarise(_parameters: ExcitationParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    done = [trial.results for trial in trials if "rms_tracking_error_rad" in trial.results]
    if not done:
        return {"trials": 0}
    return {
        "trials": len(done),
        "max_rms_tracking_error_rad": max(numbers(done, "rms_tracking_error_rad")),
        "peak_speed_rad_s": max(numbers(done, "peak_speed_rad_s")),
        "peak_current_a": max(numbers(done, "peak_current_a")),
    }


KIND = ExperimentKind(
    name="excitation",
    title="Identification motion",
    summary="Moves the joint through sines, sweeps and steady speeds under several loads: trials from which the model "
    "lab tells which physical effects are at work.",
    parameters=ExcitationParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "rms_tracking_error_rad": "root mean square of position less set point",
        "peak_speed_rad_s": "highest speed",
        "peak_current_a": "highest current",
    },
)
