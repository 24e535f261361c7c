"""Minutes of holding or moving, with short probe strokes between them: what warmth and running-in change."""

from collections.abc import Iterator
from functools import partial
from math import ceil, pi, sin
from typing import Any, Literal, Self

import numpy as np
from pydantic import model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.control.cycle import Procedure, Reading
from bench.errors import LimitError, quantity_message
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, trial_plan
from bench.experiments.parts.excursion import BRAKING_SHARE
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.profile import SetPoint, Trapezoid
from bench.experiments.parts.refusal import (
    refuse_angles,
    refuse_load,
    refuse_many,
    refuse_servo,
    refuse_slow_move,
    refuse_speed,
)
from bench.json_types import Value, known, number

OVERSHOOT_RAD = 0.1  # of the servo, at most
MIDDLE = 0.5  # of a probe stroke, the part that is measured
RESTS_S = 2.0  # to the start and back, roughly


class HoldAndSoakParameters(Parameters):
    """Parameters of hold and soak."""

    soak: Literal["hold", "move"] = quantity(
        "hold", "", "hold: at hold_rad, where the current warms the winding; move: back and forth, which warms the gear"
    )
    load_kg: float = quantity(0.1, "kg", "Load on the arm", ge=0)
    balanced: bool = quantity(False, "", "Balance the load: same weight on the axis, no gravity torque")
    hold_rad: float = quantity(pi / 2, "rad", "Angle that is held; amplitude of the motion where it moves")
    move_rad_s: float = quantity(3.0, "rad/s", "Highest speed of the motion", gt=0)
    soak_s: float = quantity(600.0, "s", "Whole time of holding or moving", gt=0, le=86_400)
    probe_every_s: float = quantity(60.0, "s", "Holding or moving between two probes", ge=1, le=3600)
    probe_rad: float = quantity(0.4, "rad", "Amplitude of a probe, either side of angle 0", gt=0)
    probe_rad_s: float = quantity(0.5, "rad/s", "Speed of a probe", gt=0)

    @model_validator(mode="after")
    def _check_parts(self) -> Self:
        if self.probe_every_s > self.soak_s:
            raise ValueError(f"probe_every_s must not be above soak_s, {self.soak_s:g} s")
        return self

    @property
    def soaks_s(self) -> list[float]:
        """Length of each part between probes."""
        count = ceil(self.soak_s / self.probe_every_s - 1e-9)
        return [self.probe_every_s] * (count - 1) + [self.soak_s - (count - 1) * self.probe_every_s]


def probe(configuration: BenchConfiguration, parameters: HoldAndSoakParameters) -> Procedure:
    """The procedure: one slow stroke forwards, one back.

    Results:
        friction_current_a: half the difference of the mean currents of both strokes, in their middle.
        load_current_a: their mean.
        temperature_c: of the drive, mean; None where it measures none.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    yield from joint.rest_at(-parameters.probe_rad)
    means_a, readings = [], []
    for sign in (1.0, -1.0):
        way = _stroke(sign, parameters, configuration)
        stroke = yield from joint.follow(way, ("probe", "forwards" if sign > 0.0 else "back"))
        middle = [
            one.current_a
            for one, point in zip(stroke, way, strict=True)
            if abs(point.position_rad) <= MIDDLE * parameters.probe_rad
        ]
        means_a.append(float(np.mean(middle)))
        readings += stroke
    yield from joint.rest_at(0.0)
    forward_a, back_a = means_a
    return {
        "friction_current_a": (forward_a - back_a) / 2.0,
        "load_current_a": (forward_a + back_a) / 2.0,
        "temperature_c": _temperature_c(readings),
    }


def soak(configuration: BenchConfiguration, parameters: HoldAndSoakParameters, seconds: float) -> Procedure:
    """The procedure: hold, or swing, for a time.

    Results:
        soaked_s: the time.
        rms_current_a: of the motor, which warms its winding.
        temperature_c: of the drive in the end; None where it measures none.
    """
    joint, period_s = Joint(configuration), configuration.control.period_s
    cycles = ceil(seconds / period_s)
    yield from joint.wake()
    begin_rad = parameters.hold_rad if parameters.soak == "hold" else 0.0
    yield from joint.rest_at(begin_rad)
    points = _swing(parameters, cycles, period_s) if parameters.soak == "move" else _held(begin_rad, cycles)
    sum_a2, last = 0.0, joint.reading
    for target_rad, velocity_rad_s in points:  # not kept: minutes are many readings
        (last,) = yield from joint.follow([SetPoint(target_rad, velocity_rad_s)])
        sum_a2 += last.current_a**2
    yield from joint.rest_at(0.0)
    return {
        "soaked_s": cycles * period_s,
        "rms_current_a": (sum_a2 / cycles) ** 0.5,
        "temperature_c": _temperature_c([last]),
    }


def _stroke(sign: float, parameters: HoldAndSoakParameters, configuration: BenchConfiguration) -> list[SetPoint]:
    acceleration = BRAKING_SHARE * configuration.motion.acceleration_rad_s2
    reach_rad, period_s = sign * parameters.probe_rad, configuration.control.period_s
    way = Trapezoid(-reach_rad, reach_rad, parameters.probe_rad_s, acceleration)
    return [way.at(cycle * period_s) for cycle in range(1, ceil(way.duration_s / period_s) + 1)]


def _held(angle_rad: float, cycles: int) -> Iterator[SetPoint]:
    return (SetPoint(angle_rad, 0.0) for _ in range(cycles))


def _swing(parameters: HoldAndSoakParameters, cycles: int, period_s: float) -> Iterator[SetPoint]:
    """Raised cosines to one side, which begin at rest; the last one ends wherever it is."""
    omega = 2.0 * parameters.move_rad_s / abs(parameters.hold_rad)
    reach_rad = parameters.hold_rad / 2.0
    for cycle in range(1, cycles + 1):
        phase = omega * cycle * period_s
        yield SetPoint(reach_rad * (1.0 - np.cos(phase)), reach_rad * omega * sin(phase))


def _temperature_c(readings: list[Reading]) -> float | None:
    return known(float(np.mean([reading.sample.temperature_c for reading in readings])))


def _plan(parameters: HoldAndSoakParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    def trial(number: int, part: str, procedure: Any) -> TrialPlan:
        name, load_kg, balanced = f"{part}-{number:03d}", parameters.load_kg, parameters.balanced
        plan = trial_plan(configuration, name, procedure, load_kg, balanced, part=part)
        plan.conditions["soaked_s"] = sum(parameters.soaks_s[: number - 1], 0.0)
        return plan

    plans = [trial(1, "probe", partial(probe, configuration, parameters))]
    for index, seconds in enumerate(parameters.soaks_s, 1):
        plans.append(trial(index, "soak", partial(soak, configuration, parameters, seconds)))
        plans.append(trial(index + 1, "probe", partial(probe, configuration, parameters)))
    return plans


def _refuse(parameters: HoldAndSoakParameters, configuration: BenchConfiguration) -> None:
    refuse_many(2 * len(parameters.soaks_s) + 1, "soak_s and probe_every_s")
    refuse_load("load_kg", parameters.load_kg, configuration)
    refuse_angles("hold_rad", [0.0, parameters.hold_rad], OVERSHOOT_RAD, configuration)
    refuse_angles("probe_rad", [-parameters.probe_rad, parameters.probe_rad], OVERSHOOT_RAD, configuration)
    refuse_speed("probe_rad_s", parameters.probe_rad_s, configuration)
    refuse_slow_move("probe_rad_s", parameters.probe_rad_s, 2.0 * parameters.probe_rad, configuration)
    refuse_servo(configuration)
    if parameters.soak == "move":
        _refuse_swing(parameters, configuration)


def _refuse_swing(parameters: HoldAndSoakParameters, configuration: BenchConfiguration) -> None:
    refuse_speed("move_rad_s", parameters.move_rad_s, configuration)
    if abs(parameters.hold_rad) < OVERSHOOT_RAD:
        allowed = f"at least {OVERSHOOT_RAD:g} either way where soak is 'move'"
        raise LimitError(quantity_message("hold_rad", parameters.hold_rad, allowed, "rad"))
    peak, allowed_rad_s2 = (
        2.0 * parameters.move_rad_s**2 / abs(parameters.hold_rad),
        BRAKING_SHARE * configuration.motion.acceleration_rad_s2,
    )
    if peak > allowed_rad_s2:
        allowed = f"at most {allowed_rad_s2:g}, a part of motion.acceleration_rad_s2"
        step = "Choose a lower move_rad_s or a larger hold_rad"
        raise LimitError(quantity_message("the acceleration of the motion", peak, allowed, "rad/s2", step))


def _duration_s(parameters: HoldAndSoakParameters, _configuration: BenchConfiguration) -> float:
    probes = len(parameters.soaks_s) + 1
    probe_s = 4.0 * parameters.probe_rad / parameters.probe_rad_s + RESTS_S
    return parameters.soak_s + RESTS_S * len(parameters.soaks_s) + probes * probe_s


def _summarise(_parameters: HoldAndSoakParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [
        {"soaked_s": trial.conditions["soaked_s"], **trial.results}
        for trial in trials
        if "friction_current_a" in trial.results
    ]
    summary: dict[str, Value] = {"rows": rows, "probes": len(rows)}
    if len(rows) > 1:
        first, last = rows[0], rows[-1]
        summary["change_friction_current_a"] = number(last["friction_current_a"]) - number(first["friction_current_a"])
        if first["temperature_c"] is not None:
            summary["change_temperature_c"] = number(last["temperature_c"]) - number(first["temperature_c"])
    return summary


KIND = ExperimentKind(
    name="hold-and-soak",
    title="Hold and soak",
    summary="Holds a load or moves for minutes, and measures friction by a short slow stroke every now and then: what "
    "warmth and running-in change.",
    parameters=HoldAndSoakParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "friction_current_a": "of a probe: half the difference of the currents forward and backward",
        "load_current_a": "of a probe: half their sum",
        "temperature_c": "of the drive, at the end",
        "soaked_s": "of a soak: how long it held or moved",
        "rms_current_a": "of a soak: root mean square of the current",
    },
)
