"""Strokes there and back, from large ones down to those within free play and pre-sliding: what reversals cost."""

from collections.abc import Iterator
from functools import partial
from itertools import pairwise, product
from math import ceil
from typing import Annotated

import numpy as np
from pydantic import Field

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.rig import resolution_rad
from bench.control.cycle import Procedure, Reading
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, trial_plan
from bench.experiments.parts.excursion import BRAKING_SHARE
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.profile import SetPoint, Trapezoid
from bench.experiments.parts.refusal import refuse_angles, refuse_load, refuse_servo, refuse_short, refuse_speed
from bench.json_types import Value, numbers

Amplitude = Annotated[float, Field(gt=0)]
OVERSHOOT_RAD = 0.1  # of the servo, at most
LEAST_COUNTS = 3.0
MIDDLE = 0.5  # of a stroke, the part whose current is averaged: run-up and braking are left out
RESTS_S = 3.0  # to the centre and back, and to settle, roughly


class ReversalsParameters(Parameters):
    """Parameters of reversals. The servo works without dead-band meanwhile, or small strokes would be none."""

    load_kg: float = quantity(0.0, "kg", "Load on the arm", ge=0)
    balanced: bool = quantity(False, "", "Balance the load: same weight on the axis, no gravity torque")
    angle_rad: float = quantity(0.0, "rad", "Angle about which the strokes go")
    amplitudes_rad: tuple[Amplitude, ...] = quantity(
        (0.5, 0.1, 0.02, 0.005, 0.002), "rad", "Way either side of the angle, one trial each", min_length=1
    )
    speed_rad_s: float = quantity(1.0, "rad/s", "Speed of the large strokes", gt=0)
    stroke_s: float = quantity(1.0, "s", "Shortest time of one stroke: small ones are slower", gt=0, le=600)
    rest_s: float = quantity(0.1, "s", "Rest at each end", ge=0, le=600)
    strokes: int = quantity(6, "", "Strokes in each trial, there and back in turn", ge=2, le=1000)
    repeats: int = quantity(1, "", "Trials of each amplitude", ge=1, le=100)

    def stroke_rad_s(self, amplitude_rad: float) -> float:
        """Top speed of the strokes of an amplitude."""
        return min(self.speed_rad_s, 2.0 * amplitude_rad / self.stroke_s)


def reverse(configuration: BenchConfiguration, parameters: ReversalsParameters, amplitude_rad: float) -> Procedure:
    """The procedure: to the angle, from end to end and back again, and to angle 0.

    Results:
        strokes: from end to end.
        reached_rad: half the way between the ends that the joint itself reached, mean of all strokes.
        friction_current_a: half the difference of the mean currents forwards and backwards, in the middle of the
            strokes; None where the strokes are too short to have one.
        load_current_a: their mean.
        rms_tracking_error_rad: over all strokes.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    yield from joint.rest_at(parameters.angle_rad)
    joint.grip(resolution_rad(configuration.rig))
    ends = _ends(parameters, amplitude_rad)
    parts: list[tuple[list[SetPoint], list[Reading]]] = []
    for begin_rad, end_rad in pairwise(ends):
        way = _way(begin_rad, end_rad, amplitude_rad, parameters, configuration)
        parts.append((way, (yield from joint.follow(way, ("reversal", f"towards {end_rad:.6g} rad")))))
    joint.grip(configuration.servo.dead_band_rad)
    yield from joint.rest_at(0.0)
    return _results(parts[1:-1])  # the first and the last are half strokes


def _ends(parameters: ReversalsParameters, amplitude_rad: float) -> Iterator[float]:
    yield parameters.angle_rad
    for stroke in range(parameters.strokes + 1):
        yield parameters.angle_rad + (amplitude_rad if stroke % 2 else -amplitude_rad)
    yield parameters.angle_rad


def _way(
    begin_rad: float, end_rad: float, amplitude_rad: float,
    parameters: ReversalsParameters, configuration: BenchConfiguration,
) -> list[SetPoint]:  # fmt: skip
    """From end to end, and the rest there."""
    period_s = configuration.control.period_s
    acceleration = BRAKING_SHARE * configuration.motion.acceleration_rad_s2
    way = Trapezoid(begin_rad, end_rad, parameters.stroke_rad_s(amplitude_rad), acceleration)
    cycles = ceil((way.duration_s + parameters.rest_s) / period_s)
    return [way.at(cycle * period_s) for cycle in range(1, cycles + 1)]


def _results(parts: list[tuple[list[SetPoint], list[Reading]]]) -> dict[str, Value]:
    means_a: dict[bool, list[float]] = {True: [], False: []}
    reached_rad, errors_rad = [], []
    for way, readings in parts:
        target_rad = np.array([point.position_rad for point in way])
        position_rad = np.array([reading.sample.position_rad for reading in readings])
        current_a = np.array([reading.current_a for reading in readings])
        middle_rad, half_rad = (target_rad[0] + target_rad[-1]) / 2.0, abs(target_rad[-1] - target_rad[0]) / 2.0
        middle = np.abs(target_rad - middle_rad) <= MIDDLE * half_rad
        if middle.any():
            means_a[bool(target_rad[-1] > target_rad[0])].append(float(np.mean(current_a[middle])))
        reached_rad.append(float(np.ptp(position_rad)) / 2.0)
        errors_rad.append(position_rad - target_rad)
    results: dict[str, Value] = {"strokes": len(parts), "reached_rad": sum(reached_rad) / len(reached_rad)}
    both = means_a[True] and means_a[False]
    forward_a, backward_a = (float(np.mean(means_a[way])) if both else None for way in (True, False))
    if forward_a is not None and backward_a is not None:
        results |= {
            "friction_current_a": (forward_a - backward_a) / 2.0,
            "load_current_a": (forward_a + backward_a) / 2.0,
        }
    error_rad = np.concatenate(errors_rad)
    return results | {"rms_tracking_error_rad": float(np.sqrt(np.mean(error_rad**2)))}


def _plan(parameters: ReversalsParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    repeats = range(1, parameters.repeats + 1)
    return [
        trial_plan(
            configuration, f"amplitude-{number:02d}-{repeat:02d}",
            partial(reverse, configuration, parameters, amplitude_rad), parameters.load_kg, parameters.balanced,
            angle_rad=parameters.angle_rad, amplitude_rad=amplitude_rad, repeat=repeat,
        )
        for (number, amplitude_rad), repeat in product(enumerate(parameters.amplitudes_rad, 1), repeats)
    ]  # fmt: skip


def _refuse(parameters: ReversalsParameters, configuration: BenchConfiguration) -> None:
    refuse_load("load_kg", parameters.load_kg, configuration)
    least_rad = LEAST_COUNTS * resolution_rad(configuration.rig)
    for amplitude_rad in parameters.amplitudes_rad:
        ends_rad = [parameters.angle_rad - amplitude_rad, parameters.angle_rad + amplitude_rad]
        refuse_angles("angle_rad and an amplitude of amplitudes_rad", [0.0, *ends_rad], OVERSHOOT_RAD, configuration)
        refuse_short("an amplitude of amplitudes_rad", amplitude_rad, least_rad, f"{LEAST_COUNTS:g} encoder counts")
    refuse_speed("speed_rad_s", parameters.speed_rad_s, configuration)
    refuse_servo(configuration)


def _duration_s(parameters: ReversalsParameters, _configuration: BenchConfiguration) -> float:
    strokes_s = [
        2.0 * amplitude_rad / parameters.stroke_rad_s(amplitude_rad) + parameters.rest_s
        for amplitude_rad in parameters.amplitudes_rad
    ]
    each = parameters.strokes + 1  # with the half strokes
    return parameters.repeats * (each * sum(strokes_s) + RESTS_S * len(parameters.amplitudes_rad))


def _summarise(_parameters: ReversalsParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [
        {**{name: trial.conditions[name] for name in ("amplitude_rad", "repeat")}, **trial.results}
        for trial in trials
        if "reached_rad" in trial.results
    ]
    return {"rows": rows, "strokes": sum(numbers(rows, "strokes"))}


KIND = ExperimentKind(
    name="reversals",
    title="Reversals",
    summary="Strokes there and back, from large amplitudes down to those within free play and pre-sliding. "
    "It shows what a reversal costs, and how friction turns round.",
    parameters=ReversalsParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "strokes": "strokes of the trial",
        "reached_rad": "amplitude that was reached, mean",
        "friction_current_a": "half the difference of the currents forward and backward",
        "load_current_a": "half their sum",
        "rms_tracking_error_rad": "root mean square of position less set point",
    },
)
