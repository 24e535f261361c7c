"""Repeated steps from angle 0 to one angle, under one load (Fig. 4 of the paper)."""

from functools import partial
from math import sqrt

from pydantic import model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.reflected_load import reflected_load_kg
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, a_current, trial_plan
from bench.experiments.parts.at_rest import AT_REST_RESULTS, RIGHT_ANGLE_RAD, duration_s, measure_at_rest
from bench.experiments.parts.refusal import refuse_angles, refuse_currents, refuse_load, refuse_slow_move, refuse_speed
from bench.json_types import Value, numbers

GOLDEN_SECTION = (sqrt(5.0) - 1.0) / 2.0


class StepsParameters(Parameters):
    """Parameters of repeated steps.

    No two approaches of an operator are alike, and a real joint never repeats itself. A simulated one would: hence
    the spread of approach speeds.
    """

    load_kg: float = quantity(0.1, "kg", "Load at the tip of the arm", ge=0)
    angle_rad: float = quantity(RIGHT_ANGLE_RAD, "rad", "Angle that is stepped to; 0 is vertically down")
    repeats: int = quantity(25, "", "Number of steps", ge=1, le=1000)
    searches: int = quantity(1, "", "Zero-speed searches in each trial, of which the mean is taken", ge=1, le=20)
    slowest_rad_s: float = quantity(0.5, "rad/s", "Slowest approach", gt=0)
    fastest_rad_s: float = quantity(4.0, "rad/s", "Fastest approach; as the slowest for steps that are all alike", gt=0)

    @model_validator(mode="after")
    def _check_order(self) -> "StepsParameters":
        if self.slowest_rad_s > self.fastest_rad_s:
            raise ValueError(f"slowest_rad_s must not be above fastest_rad_s, {self.fastest_rad_s:g} rad/s")
        return self

    def approach_rad_s(self, repeat: int) -> float:
        """Speed of one approach. Spread evenly between the bounds in no order (golden-section sequence)."""
        share = repeat * GOLDEN_SECTION % 1.0
        return self.slowest_rad_s + share * (self.fastest_rad_s - self.slowest_rad_s)


def _plan(parameters: StepsParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [
        trial_plan(
            configuration,
            f"step-{repeat:03d}",
            partial(
                measure_at_rest,
                configuration,
                parameters.angle_rad,
                parameters.searches,
                parameters.approach_rad_s(repeat),
            ),
            parameters.load_kg,
            angle_rad=parameters.angle_rad,
            approach_rad_s=parameters.approach_rad_s(repeat),
            repeat=repeat,
        )
        for repeat in range(1, parameters.repeats + 1)
    ]


def _refuse(parameters: StepsParameters, configuration: BenchConfiguration) -> None:
    refuse_load("load_kg", parameters.load_kg, configuration)
    refuse_angles("angle_rad", [0.0, parameters.angle_rad], configuration.search.excursion_rad, configuration)
    refuse_speed("fastest_rad_s", parameters.fastest_rad_s, configuration)
    refuse_speed("motion.speed_rad_s", configuration.motion.speed_rad_s, configuration)
    refuse_slow_move("slowest_rad_s", parameters.slowest_rad_s, parameters.angle_rad, configuration)
    refuse_slow_move("motion.speed_rad_s", configuration.motion.speed_rad_s, parameters.angle_rad, configuration)
    refuse_currents(configuration)
    reflected_load_kg(0.0, parameters.angle_rad, configuration.rig)


def _duration_s(parameters: StepsParameters, configuration: BenchConfiguration) -> float:
    return parameters.repeats * duration_s(configuration, parameters.searches)


def _summarise(_parameters: StepsParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    results = [trial.results for trial in trials]
    steady_a = numbers(results, "steady_current_a")
    load_a = numbers(results, "load_current_a")
    reflected_kg = numbers(results, "reflected_load_kg")
    summary: dict[str, Value] = {"steps": len(trials), "estimates": len(load_a)}
    for name, values in (
        ("steady_current_a", steady_a),
        ("load_current_a", load_a),
        ("reflected_load_kg", reflected_kg),
    ):
        if values:
            summary |= {
                f"min_{name}": min(values),
                f"max_{name}": max(values),
                f"spread_{name}": max(values) - min(values),
                f"mean_{name}": sum(values) / len(values),
            }
    if load_a and max(load_a) > min(load_a):
        summary["spread_ratio"] = (max(steady_a) - min(steady_a)) / (max(load_a) - min(load_a))
    return summary


KIND = ExperimentKind(
    name="steps",
    title="Repeated steps",
    summary="Steps the joint to one angle again and again, approaching it at a different speed each time. The steady "
    "current differs from step to step, because friction holds the joint; the friction-compensated current does not.",
    parameters=StepsParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results=AT_REST_RESULTS,
    modes=a_current,
)
