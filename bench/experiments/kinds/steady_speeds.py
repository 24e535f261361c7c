"""One load carried at several steady speeds, with the load estimated all along (Fig. 11 of the paper)."""

from functools import partial
from math import ceil, pi
from typing import Annotated

from pydantic import Field, model_validator

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.control.cycle import Procedure
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, a_current, trial_plan
from bench.experiments.parts.followed_motion import ERROR_RESULTS, Followed, FollowedJoint, errors, refuse_unknown_joint
from bench.experiments.parts.profile import SetPoint, Trapezoid
from bench.experiments.parts.refusal import refuse_angles, refuse_load, refuse_servo, refuse_slow_move, refuse_speed
from bench.json_types import Value, numbers

PAPER_RPM = (100, 200, 400, 600, 800, 1000, 1200)
PAPER_RATIO = 20.0  # of the rig whose motor turns that fast
PAPER_SPEEDS_RAD_S = tuple(round(rpm * 2.0 * pi / 60.0 / PAPER_RATIO, 3) for rpm in PAPER_RPM)
STEADY_SHARE = 0.7  # of the way at speed, the later part: by then the run-up has died away
HOLD_S = 0.6  # at either end, so that a stroke begins at rest
OVERSHOOT_RAD = 0.1  # of the servo, at most
REST_S = 8.0  # to settle, to search, to go to the ends and back, roughly
Speed = Annotated[float, Field(gt=0)]


class SteadySpeedsParameters(Parameters):
    """Parameters of steady speeds. Each is run through the whole travel, there and back."""

    load_kg: float = quantity(0.1, "kg", "Load at the tip of the arm", ge=0)
    speeds_rad_s: tuple[Speed, ...] = quantity(
        PAPER_SPEEDS_RAD_S, "rad/s", "Speeds of the joint, one trial each", min_length=1
    )
    reach_rad: float = quantity(2.0, "rad", "Ends of the travel, either way of straight down", gt=0)
    run_up_rad: float = quantity(1.5, "rad", "Way to run up; gently, or the teeth rattle", gt=0)
    brake_rad: float = quantity(0.5, "rad", "Way to brake", gt=0)

    @model_validator(mode="after")
    def _check_way(self) -> "SteadySpeedsParameters":
        if self.run_up_rad + self.brake_rad >= 2.0 * self.reach_rad:
            raise ValueError(f"run_up_rad and brake_rad must be below twice reach_rad, {2.0 * self.reach_rad:g} rad")
        return self


def carry_at_speed(
    configuration: BenchConfiguration, parameters: SteadySpeedsParameters, speed_rad_s: float
) -> Procedure:
    """The procedure.

    Results: as `followed_motion.errors`, over the steady parts of both strokes; search_failure; and of each stroke
    alone, forward_mean_error_kg and backward_mean_error_kg.
    """
    joint = FollowedJoint(configuration)
    failure = yield from joint.begin()
    if failure:
        yield from joint.end()
        return {"estimates": 0, "search_failure": failure}
    reach_rad, steady, means = parameters.reach_rad, [], {}
    period_s, motion = configuration.control.period_s, configuration.motion
    there = Trapezoid(0.0, -reach_rad, motion.speed_rad_s, motion.acceleration_rad_s2)
    yield from joint.follow([there.at(cycle * period_s) for cycle in range(1, ceil(there.duration_s / period_s) + 1)])
    for name, way in (("forward", 1.0), ("backward", -1.0)):
        yield from joint.follow([SetPoint(-way * reach_rad, 0.0)] * round(HOLD_S / period_s))
        stroke = _stroke(parameters, way, speed_rad_s, period_s)
        followed = yield from joint.follow(stroke)
        measured = _steady(followed, stroke, speed_rad_s)
        means[f"{name}_mean_error_kg"] = errors(measured, parameters.load_kg, configuration).get("mean_error_kg")
        steady += measured
    yield from joint.end()
    return errors(steady, parameters.load_kg, configuration) | means | {"search_failure": ""}


def _stroke(parameters: SteadySpeedsParameters, way: float, speed_rad_s: float, period_s: float) -> list[SetPoint]:
    """From one end to the other: a long run-up, the way at speed, a short braking."""
    run_up_rad, brake_rad, reach_rad = parameters.run_up_rad, parameters.brake_rad, parameters.reach_rad
    loss = speed_rad_s**2 / (2.0 * brake_rad)
    at_speed_s = run_up_s(run_up_rad, speed_rad_s)
    braking_s = at_speed_s + (2.0 * reach_rad - run_up_rad - brake_rad) / speed_rad_s
    end_s = braking_s + 2.0 * brake_rad / speed_rad_s
    points = []
    for cycle in range(1, ceil(end_s / period_s) + 1):
        time_s, left_s = cycle * period_s, max(end_s - cycle * period_s, 0.0)
        if time_s < at_speed_s:
            gone_rad, speed = run_up(run_up_rad, speed_rad_s, time_s)
        elif time_s < braking_s:
            gone_rad, speed = run_up_rad + speed_rad_s * (time_s - at_speed_s), speed_rad_s
        else:
            gone_rad, speed = 2.0 * reach_rad - 0.5 * loss * left_s**2, loss * left_s
        points.append(SetPoint(way * (gone_rad - reach_rad), way * speed))
    return points


def run_up_s(way_rad: float, speed_rad_s: float) -> float:
    """Time that a run-up takes [s]: half of it with one acceleration a, in the other half this fades to 0, linearly.

    An acceleration that ends at once lets the arm fall through the free play, and rattle there all the way.

        v = 1.5 a T,  s = 11/6 a T^2  after two times T,  so  2 T = 18/11 s / v
    """
    return 18.0 / 11.0 * way_rad / speed_rad_s


def run_up(way_rad: float, speed_rad_s: float, time_s: float) -> tuple[float, float]:
    """How far [rad] and how fast [rad/s] a run-up has come after a time [s]."""
    half_s = run_up_s(way_rad, speed_rad_s) / 2.0
    gain = speed_rad_s / (1.5 * half_s)
    early_s, late_s = min(time_s, half_s), max(time_s - half_s, 0.0)
    speed = gain * (early_s + late_s - late_s**2 / (2.0 * half_s))
    gone_rad = gain * (0.5 * early_s**2 + early_s * late_s + 0.5 * late_s**2 - late_s**3 / (6.0 * half_s))
    return gone_rad, speed


def _steady(followed: list[Followed], stroke: list[SetPoint], speed_rad_s: float) -> list[Followed]:
    """The later part of the way on which the set point keeps its speed."""
    at_speed = [one for one, point in zip(followed, stroke, strict=True) if abs(point.velocity_rad_s) == speed_rad_s]
    return at_speed[-round(STEADY_SHARE * len(at_speed)) :]


def _plan(parameters: SteadySpeedsParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [
        trial_plan(
            configuration,
            f"speed-{number:02d}",
            partial(carry_at_speed, configuration, parameters, speed_rad_s),
            parameters.load_kg,
            held_speed_rad_s=speed_rad_s,
        )
        for number, speed_rad_s in enumerate(parameters.speeds_rad_s, 1)
    ]


def _refuse(parameters: SteadySpeedsParameters, configuration: BenchConfiguration) -> None:
    refuse_load("load_kg", parameters.load_kg, configuration)
    reach_rad = parameters.reach_rad
    refuse_angles("reach_rad", [-reach_rad, reach_rad], OVERSHOOT_RAD, configuration)
    for speed_rad_s in parameters.speeds_rad_s:
        refuse_speed("a speed of speeds_rad_s", speed_rad_s, configuration)
        refuse_slow_move("a speed of speeds_rad_s", speed_rad_s, 2.0 * reach_rad, configuration)
    refuse_servo(configuration)
    refuse_unknown_joint(configuration)


def _duration_s(parameters: SteadySpeedsParameters, _configuration: BenchConfiguration) -> float:
    return sum(REST_S + 4.0 * parameters.reach_rad / speed_rad_s for speed_rad_s in parameters.speeds_rad_s)


def _summarise(_parameters: SteadySpeedsParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [{**trial.conditions, **trial.results} for trial in trials if trial.results.get("estimates")]
    summary: dict[str, Value] = {"rows": rows, "speeds": len(rows)}
    for name in ("mean_absolute_error_kg", "uncompensated_mean_absolute_error_kg", "in_band"):
        if rows:
            summary[name] = sum(numbers(rows, name)) / len(rows)
    return summary


KIND = ExperimentKind(
    name="steady-speeds",
    title="Steady speeds",
    summary="Carries one load through the travel at several steady speeds and estimates it all along, from the "
    "calibration in use. The estimate is compared with the weight that hangs there.",
    parameters=SteadySpeedsParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        **ERROR_RESULTS,
        "forward_mean_error_kg": "mean error of the estimate, forward",
        "backward_mean_error_kg": "mean error of the estimate, backward",
    },
    modes=a_current,
)
