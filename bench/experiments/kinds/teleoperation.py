"""A master and a slave: the slave follows, and its load is reflected to the operator, with compensation and without."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import sqrt

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.reflected_load import torque_n_m_a
from bench.control.cycle import PairProcedure, Reach
from bench.control.drive_factory import is_simulated
from bench.errors import ConfigurationError, LimitError, quantity_message
from bench.experiments.analysis.reflection_results import error_results, rest_results, truth_n_m, widest_swing
from bench.experiments.analysis.stability_margin import STAGE_S, ladder, margin
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, a_current, trial_plan
from bench.experiments.parts.load_follower import LoadFollower
from bench.experiments.parts.pair_joints import MARGIN_RAD, Coupling, PairJoints, PairPart, Way
from bench.experiments.parts.refusal import refuse_angles, refuse_currents, refuse_load, refuse_speed
from bench.json_types import Value, number, numbers
from compensator.lab.recordings.recording import Condition

LEAD_S = 0.5  # coupled, before the first reach and after the last
REST_S = 6.0  # to settle, to search, and back, roughly
PEAK = 1.875  # speed of a reach of least jerk, over its mean
WATCHED = 0.5  # of a rest, its later part


class TeleoperationParameters(Parameters):
    """Parameters of a teleoperation. A simulated operator reaches from angle to angle; a person is free."""

    load_kg: float = quantity(0.1, "kg", "Load at the tip of the slave's arm", ge=0)
    wall_rad: float | None = quantity(None, "rad", "Angle of a wall in the way of the slave; none where left out")
    angles_rad: tuple[float, ...] = quantity(
        (1.2, 0.6, 1.5, -0.8), "rad", "Angles that the operator reaches for, one after the other", min_length=1
    )
    reach_s: float = quantity(1.0, "s", "Time of a reach", gt=0, le=60)
    rest_s: float = quantity(2.0, "s", "Rest after each reach", gt=0, le=60)
    reflect: tuple[Way, ...] = quantity(
        ("compensated", "raw"), "", "What is reflected, a trial each: compensated, raw (the whole current) or none",
        min_length=1,
    )  # fmt: skip
    force_scale: float = quantity(1.0, "", "Torque at the master per torque at the slave", gt=0, le=20)
    motion_scale: float = quantity(1.0, "", "Way of the slave per way of the master", gt=0, le=10)
    find_margin: bool = quantity(
        False, "", "Look for the largest force scale without a limit cycle at rest; simulated pairs only"
    )
    largest_force_scale: float = quantity(4.0, "", "Largest force scale that is tried for that", gt=0, le=20)
    repeats: int = quantity(1, "", "Number of trials of each", ge=1, le=100)


def teleoperate(configuration: BenchConfiguration, parameters: TeleoperationParameters, way: Way) -> PairProcedure:
    """The procedure.

    Results: as `reflection_results`, over everything from the first reach to the last rest; search_failure; and where
    it was asked for, what `stability_margin.margin` finds at the last angle.
    """
    pair = PairJoints(configuration, Coupling(way, parameters.force_scale, parameters.motion_scale))
    failure = yield from pair.begin()
    if failure:
        yield from pair.end()
        return {"cycles_conveyed": 0, "search_failure": failure}
    pair.couple()
    yield from pair.convey(LEAD_S)
    results = yield from _reaches(pair, configuration, parameters)
    if parameters.find_margin:
        found = yield from margin(pair, configuration, parameters.angles_rad[-1], parameters.largest_force_scale)
        results |= found
    yield from pair.convey(parameters.reach_s + LEAD_S, Reach(0.0, parameters.reach_s))
    yield from pair.end()
    return results | {"search_failure": ""}


def _reaches(
    pair: PairJoints, configuration: BenchConfiguration, parameters: TeleoperationParameters
) -> PairPart[dict[str, Value]]:
    """Reach, rest, reach, rest: what that told."""
    conveyed, truths, rests = [], [], []
    for angle_rad in parameters.angles_rad:
        reached = yield from pair.convey(parameters.reach_s, Reach(angle_rad, parameters.reach_s))
        rested = yield from pair.convey(parameters.rest_s)
        stretch = reached + rested
        truth = truth_n_m(stretch, parameters.load_kg, parameters.wall_rad is not None, configuration)
        watched = rested[-max(round(WATCHED * len(rested)), 1) :]
        error = np.array([one.reflected_n_m for one in watched]) / parameters.force_scale - truth[-len(watched) :]
        rests.append((widest_swing(watched, configuration), sqrt(float(np.mean(error**2)))))
        conveyed += stretch
        truths.append(truth)
    told = error_results(conveyed, np.concatenate(truths), parameters.force_scale, configuration)
    return {"cycles_conveyed": len(conveyed)} | told | rest_results(rests)


def _plan(parameters: TeleoperationParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    wall: dict[str, Condition] = {} if parameters.wall_rad is None else {"wall_rad": parameters.wall_rad}
    plans = [
        trial_plan(
            configuration, f"{way}-{repeat:02d}", partial(teleoperate, configuration, parameters, way),
            parameters.load_kg, False, reflect=way, force_scale=parameters.force_scale,
            motion_scale=parameters.motion_scale, repeat=repeat, **wall,
        )
        for repeat in range(1, parameters.repeats + 1)
        for way in parameters.reflect
    ]  # fmt: skip
    return [replace(plan, wall_rad=parameters.wall_rad) for plan in plans]


def _refuse(parameters: TeleoperationParameters, configuration: BenchConfiguration) -> None:
    master = configuration.of_master()
    if configuration.servo.closed_by == "drive":
        raise ConfigurationError("teleoperation closes the slave's position loop itself; set servo.closed_by = 'bench'")
    refuse_currents(configuration)
    LoadFollower(configuration)
    torque_n_m_a(configuration.rig)
    refuse_load("load_kg", parameters.load_kg, configuration)
    angles_rad = parameters.angles_rad
    refuse_angles("angles_rad", angles_rad, MARGIN_RAD, master)
    scaled = [parameters.motion_scale * angle_rad for angle_rad in angles_rad]
    refuse_angles("motion_scale times angles_rad", scaled, MARGIN_RAD, configuration)
    way_rad = max(abs(after - before) for before, after in pairwise((0.0, *angles_rad, 0.0)))
    peak_rad_s = PEAK * way_rad / parameters.reach_s
    refuse_speed("the peak speed of a reach", peak_rad_s, master)
    refuse_speed("motion_scale times the peak speed of a reach", parameters.motion_scale * peak_rad_s, configuration)
    refuse_speed("motion.speed_rad_s", configuration.motion.speed_rad_s, configuration)
    asked_a = configuration.require_master().reflection.torque_n_m / torque_n_m_a(master.rig)
    if asked_a > master.limits.current_a:
        allowed = f"at most master.limits.current_a, {master.limits.current_a:g}"
        step = "Lower master.reflection.torque_n_m"
        raise LimitError(quantity_message("current of master.reflection.torque_n_m", asked_a, allowed, "A", step))
    if parameters.find_margin and not is_simulated(configuration):
        raise LimitError(
            "find_margin drives the pair to where it swings without end; that is for simulated pairs only. Leave it out"
        )
    if parameters.wall_rad == 0.0:
        raise LimitError("wall_rad is 0 rad, where the arm hangs; choose an angle above or below")


def _duration_s(parameters: TeleoperationParameters, _configuration: BenchConfiguration) -> float:
    trial_s = REST_S + 2.0 * LEAD_S + parameters.reach_s
    trial_s += len(parameters.angles_rad) * (parameters.reach_s + parameters.rest_s)
    if parameters.find_margin:
        trial_s += STAGE_S * len(ladder(parameters.largest_force_scale))
    return parameters.repeats * len(parameters.reflect) * trial_s


def _summarise(parameters: TeleoperationParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [{**trial.conditions, **trial.results} for trial in trials if trial.results.get("cycles_conveyed")]
    summary: dict[str, Value] = {"rows": rows, "trials": len(rows)}
    for way in parameters.reflect:
        of_way = [row for row in rows if row["reflect"] == way]
        for name, whole in _WHOLE.items():
            found = numbers(of_way, name)
            if found:
                summary[f"{way}_{name}"] = whole(found)
    ours, raw = (summary.get(f"{way}_reflected_error_rms_n_m") for way in ("compensated", "raw"))
    if ours is not None and raw is not None:
        summary["error_ratio"] = number(ours) / number(raw)
    return summary


def _mean(values: list[float]) -> float:
    return sum(values) / len(values)


_WHOLE: dict[str, Callable[[list[float]], Value]] = {
    "reflected_error_rms_n_m": _mean,
    "reflected_error_max_n_m": max,
    "reflected_error_rms_g": _mean,
    "reflected_error_max_g": max,
    "rest_error_rms_n_m": _mean,
    "felt_error_rms_n_m": _mean,
    "least_error_max_g": max,
    "late_error_max_g": max,
    "latency_s": _mean,
    "rise_s": _mean,
    "drag_n_m": _mean,
    "limit_cycle_amplitude_rad": max,
    "limit_cycle": any,
    "stability_margin": min,
    "stability_margin_at_least": all,
}

KIND = ExperimentKind(
    name="teleoperation",
    title="Teleoperation",
    summary="The operator moves the master, the slave follows under a load or against a wall, and its load is "
    "reflected to the operator's hand: compensated, and for comparison the whole motor current. Error, delay and "
    "whether the pair swings at rest. Needs a [master], and friction curves.",
    parameters=TeleoperationParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results={
        "cycles_conveyed": "cycles in which the pair was coupled",
        "reflected_error_rms_n_m": "error of the reflected load, root mean square; grams: at the tip of a level arm",
        "reflected_error_max_n_m": "the largest",
        "reflected_error_rms_g": "root mean square",
        "reflected_error_max_g": "the largest",
        "least_error_max_g": "the largest that a pair would have that knew the truth of the cycle before",
        "late_error_max_g": "the largest that lateness does not explain",
        "latency_s": "by which the reflected load is late",
        "rise_s": "that it takes to follow a jump",
        "drag_n_m": "torque against the operator's motion",
        "felt_error_rms_n_m": "error of what the hand feels, root mean square",
        "rest_error_rms_n_m": "error at rest, root mean square",
        "limit_cycle_amplitude_rad": "widest swing at rest",
        "limit_cycle_turns": "most turns of a swing at rest",
        "limit_cycle": "whether the pair swings at rest by itself",
        "stability_margin": "largest scale of the force without swinging, where it was asked for",
        "stability_margin_at_least": "whether nothing swung up to the largest scale that was tried",
        "stability_margin_step": "how finely it was looked for",
        "search_failure": "why the load was not found at the beginning; empty where it was",
    },
    modes=a_current,
    pair=True,
)
