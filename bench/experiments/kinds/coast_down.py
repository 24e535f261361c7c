"""Run up, take the current away, and record until the joint rests: friction and inertia without the motor."""

from dataclasses import replace
from functools import partial
from itertools import product
from math import ceil
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.rig import resolution_rad
from bench.control.cycle import OFF, Procedure, Reading
from bench.experiments.analysis.coast_fit import fit_coast
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, trial_plan
from bench.experiments.parts.excursion import Excursion
from bench.experiments.parts.joint import Joint, Part
from bench.experiments.parts.profile import SetPoint, run_up
from bench.experiments.parts.refusal import refuse_coasting, refuse_load, refuse_servo, refuse_speed
from bench.experiments.parts.search import STILL_COUNTS
from bench.experiments.parts.stroke import StrokeSettings, refuse_travel
from bench.json_types import Value, known, numbers
from drivers.contract import Command, Mode

Speed = Annotated[float, Field(gt=0)]
DIRECTIONS = {"forward": 1.0, "backward": -1.0}
COAST_S2_RAD = 0.15  # of a coast, per speed: friction of the usual kind
CRUISE_S = 0.1  # at speed, so that the servo has caught up
SWITCHING_S = 0.2  # until a power stage that was off brakes again, at most
RESTS_S = 2.0  # to the start and back, roughly


class CoastDownParameters(Parameters):
    """Parameters of a coast-down. An arm that hangs out of balance swings: balance it."""

    load_kg: float = quantity(0.0, "kg", "Load on the arm", ge=0)
    balanced: bool = quantity(True, "", "Balance the load: same weight on the axis, no gravity torque")
    speeds_rad_s: tuple[Speed, ...] = quantity(
        (1.0, 2.0, 4.0), "rad/s", "Speeds at which the joint is released, each in both directions", min_length=1
    )
    released: Literal["current", "off"] = quantity(
        "current", "", "current: the drive holds a current of zero; off: the power stage is off, the winding as it may"
    )
    acceleration_rad_s2: float = quantity(18.5, "rad/s2", "Of the run-up", gt=0)
    coast_s: float = quantity(10.0, "s", "Longest coast; the joint is braked then", gt=0, le=600)
    repeats: int = quantity(1, "", "Trials at each speed and direction", ge=1, le=100)


def coast_down(
    configuration: BenchConfiguration, parameters: CoastDownParameters, speed_rad_s: float, direction: str
) -> Procedure:
    """The procedure: from the near end of the travel to speed, released, and back to angle 0.

    Results, along the direction:
        released_speed_rad_s: mean speed of the last cycles before.
        coast_s, way_rad: until it stood, or was braked.
        came_to_rest: False where travel or time did not suffice.
        dry_deceleration_rad_s2, time_constant_s: dv/dt = -a - v / T above a fifth of the first speed; None where
            that does not tell.
        fit_rms_rad: of the position against that law.
    """
    joint, sign = Joint(configuration), DIRECTIONS[direction]
    excursion = _excursion(configuration, parameters)
    near_rad = excursion.low_rad if sign > 0.0 else excursion.high_rad
    yield from joint.wake()
    yield from joint.rest_at(near_rad, acceleration_rad_s2=parameters.acceleration_rad_s2)
    before = yield from joint.follow(_to_speed(near_rad, sign * speed_rad_s, parameters, configuration))
    readings, at_rest = yield from _coast(joint, parameters, configuration, excursion)
    if not at_rest:
        yield from joint.brake(excursion.braking_rad_s2)
    yield from joint.rest_at(0.0, acceleration_rad_s2=parameters.acceleration_rad_s2)
    return _results(before, readings, at_rest, sign, configuration.control.period_s)


def _to_speed(
    near_rad: float, speed_rad_s: float, parameters: CoastDownParameters, configuration: BenchConfiguration
) -> list[SetPoint]:
    period_s = configuration.control.period_s
    points = run_up(near_rad, speed_rad_s, parameters.acceleration_rad_s2, period_s)
    last_rad = near_rad + np.sign(speed_rad_s) * speed_rad_s**2 / (2.0 * parameters.acceleration_rad_s2)
    cruise = range(1, ceil(CRUISE_S / period_s) + 1)
    return points + [SetPoint(last_rad + speed_rad_s * cycle * period_s, speed_rad_s) for cycle in cruise]


def _coast(
    joint: Joint, parameters: CoastDownParameters, configuration: BenchConfiguration, excursion: Excursion
) -> Part[tuple[list[Reading], bool]]:
    """The readings, and whether it stands."""
    command = OFF if parameters.released == "off" else Command(Mode.CURRENT, 0.0)
    still_rad, settled = STILL_COUNTS * resolution_rad(configuration.rig), configuration.motion.settled_cycles
    readings: list[Reading] = []
    rest_rad, still = joint.reading.sample.position_rad, 0
    for cycle in range(ceil(parameters.coast_s / configuration.control.period_s)):
        event = ("coast", "released") if cycle == 0 else None
        readings.append((yield from joint.push(command, event)))
        position_rad = readings[-1].sample.position_rad
        if abs(position_rad - rest_rad) > still_rad:
            rest_rad, still = position_rad, 0
        still += 1
        if still > settled:
            return readings, True
        if excursion.used_up(readings[-1]):
            break
    return readings, False


def _results(
    before: list[Reading], readings: list[Reading], at_rest: bool, sign: float, period_s: float
) -> dict[str, Value]:
    time_s = np.array([reading.time_s for reading in readings])
    way_rad = sign * np.array([reading.sample.position_rad for reading in readings])
    found = fit_coast(time_s, way_rad)
    cruise = before[-ceil(CRUISE_S / period_s / 2) - 1 :]
    cruised_rad = sign * (cruise[-1].sample.position_rad - cruise[0].sample.position_rad)
    moving = np.flatnonzero(np.diff(way_rad) != 0.0)
    last = int(moving[-1]) + 1 if len(moving) else 0
    return {
        "released_speed_rad_s": cruised_rad / (cruise[-1].time_s - cruise[0].time_s),
        "coast_s": float(time_s[last] - time_s[0]),
        "way_rad": float(way_rad[last] - way_rad[0]),
        "came_to_rest": at_rest,
        "dry_deceleration_rad_s2": known(found.dry_deceleration_rad_s2),
        "time_constant_s": known(found.time_constant_s),
        "fit_rms_rad": known(found.rms_rad),
    }  # fmt: skip


def _excursion(configuration: BenchConfiguration, parameters: CoastDownParameters) -> Excursion:
    reaction_s = SWITCHING_S if parameters.released == "off" else 0.0
    return replace(Excursion.of(configuration), reaction_s=reaction_s)


def _plan(parameters: CoastDownParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    speeds, repeats = enumerate(parameters.speeds_rad_s, 1), range(1, parameters.repeats + 1)
    return [
        trial_plan(
            configuration, f"speed-{number:02d}-{direction}-{repeat:02d}",
            partial(coast_down, configuration, parameters, speed_rad_s, direction), parameters.load_kg,
            parameters.balanced, released_speed_rad_s=speed_rad_s, released=parameters.released, direction=direction,
            repeat=repeat,
        )
        for (number, speed_rad_s), direction, repeat in product(speeds, DIRECTIONS, repeats)
    ]  # fmt: skip


def _refuse(parameters: CoastDownParameters, configuration: BenchConfiguration) -> None:
    refuse_load("load_kg", parameters.load_kg, configuration)
    if parameters.released == "off":
        refuse_coasting(configuration)
    excursion = _excursion(configuration, parameters)
    travel = StrokeSettings(
        excursion.low_rad, excursion.high_rad, max(parameters.speeds_rad_s),
        min(parameters.acceleration_rad_s2, excursion.braking_rad_s2), parameters.coast_s, CRUISE_S,
    )  # fmt: skip
    for speed_rad_s in parameters.speeds_rad_s:
        refuse_speed("a speed of speeds_rad_s and a fifth", 1.2 * speed_rad_s, configuration)
        refuse_travel("a speed of speeds_rad_s", speed_rad_s, travel)
    refuse_servo(configuration)
    resolution_rad(configuration.rig)


def _duration_s(parameters: CoastDownParameters, _configuration: BenchConfiguration) -> float:
    coasts_s = sum(min(0.1 + COAST_S2_RAD * speed_rad_s, parameters.coast_s) for speed_rad_s in parameters.speeds_rad_s)
    return len(DIRECTIONS) * parameters.repeats * (coasts_s + RESTS_S * len(parameters.speeds_rad_s))


def _summarise(_parameters: CoastDownParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [{**trial.conditions, **trial.results} for trial in trials if "coast_s" in trial.results]
    summary: dict[str, Value] = {"rows": rows, "coasts": len(rows)}
    for name in ("dry_deceleration_rad_s2", "time_constant_s"):
        values = numbers(rows, name)
        if values:
            summary[f"mean_{name}"] = sum(values) / len(values)
    return summary


def _modes(parameters: CoastDownParameters) -> frozenset[Mode]:
    return frozenset({Mode.CURRENT}) if parameters.released == "current" else frozenset()


KIND = ExperimentKind(
    name="coast-down",
    title="Coast-down",
    summary="Runs the balanced arm up to a speed, takes the current away and records until it rests. How it slows down "
    "tells friction over inertia, without the motor's constants.",
    parameters=CoastDownParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "released_speed_rad_s": "speed at which the current was taken away",
        "coast_s": "time of the coast",
        "way_rad": "its way",
        "came_to_rest": "whether it ended at rest",
        "dry_deceleration_rad_s2": "dry friction over inertia; null where it is not known",
        "time_constant_s": "inertia over viscous friction; null where it is not known",
        "fit_rms_rad": "what the fit of both leaves, root mean square",
    },
    modes=_modes,
)
