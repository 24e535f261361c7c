"""Loads from nothing to the heaviest at one or more angles, each with the zero-speed search (Figs 7, 9, Table 1)."""

from functools import partial
from math import sqrt
from typing import Annotated

from pydantic import Field

from bench.config.configuration import BenchConfiguration
from bench.config.quantities import quantity
from bench.config.reflected_load import reflected_load_kg
from bench.experiments.kind import ExperimentKind, FinishedTrial, Parameters, TrialPlan, a_current, trial_plan
from bench.experiments.parts.at_rest import AT_REST_RESULTS, RIGHT_ANGLE_RAD, duration_s, measure_at_rest
from bench.experiments.parts.refusal import (
    refuse_angles,
    refuse_currents,
    refuse_load,
    refuse_many,
    refuse_slow_move,
    refuse_speed,
)
from bench.json_types import Value, number

PAPER_LOADS_KG = tuple(round(0.01 * step, 2) for step in range(11))
Load = Annotated[float, Field(ge=0)]


class LoadSweepParameters(Parameters):
    """Parameters of a load sweep."""

    loads_kg: tuple[Load, ...] = quantity(PAPER_LOADS_KG, "kg", "Loads, in the order they are hung", min_length=1)
    angles_rad: tuple[float, ...] = quantity(
        (0.0, RIGHT_ANGLE_RAD), "rad", "Angles; 0 is vertically down", min_length=1
    )
    repeats: int = quantity(1, "", "Trials at each load and angle", ge=1, le=100)
    searches: int = quantity(2, "", "Zero-speed searches in each trial, of which the mean is taken", ge=1, le=20)


def _plan(parameters: LoadSweepParameters, configuration: BenchConfiguration) -> list[TrialPlan]:
    return [
        trial_plan(
            configuration,
            f"load-{number:02d}-angle-{place}-{repeat:02d}",
            partial(measure_at_rest, configuration, angle_rad, parameters.searches),
            load_kg,
            angle_rad=angle_rad,
            repeat=repeat,
        )
        for number, load_kg in enumerate(parameters.loads_kg, 1)
        for place, angle_rad in enumerate(parameters.angles_rad, 1)
        for repeat in range(1, parameters.repeats + 1)
    ]


def _refuse(parameters: LoadSweepParameters, configuration: BenchConfiguration) -> None:
    refuse_many(_trials(parameters), "loads_kg, angles_rad and repeats")
    for load_kg in parameters.loads_kg:
        refuse_load("a load of loads_kg", load_kg, configuration)
    margin_rad = configuration.search.excursion_rad
    refuse_angles("an angle of angles_rad", [0.0, *parameters.angles_rad], margin_rad, configuration)
    refuse_speed("motion.speed_rad_s", configuration.motion.speed_rad_s, configuration)
    farthest_rad = max(map(abs, parameters.angles_rad))
    refuse_slow_move("motion.speed_rad_s", configuration.motion.speed_rad_s, farthest_rad, configuration)
    refuse_currents(configuration)
    reflected_load_kg(0.0, RIGHT_ANGLE_RAD, configuration.rig)


def _trials(parameters: LoadSweepParameters) -> int:
    return len(parameters.loads_kg) * len(parameters.angles_rad) * parameters.repeats


def _duration_s(parameters: LoadSweepParameters, configuration: BenchConfiguration) -> float:
    return _trials(parameters) * duration_s(configuration, parameters.searches)


def _summarise(_parameters: LoadSweepParameters, trials: list[FinishedTrial]) -> dict[str, Value]:
    rows = [
        {
            "load_kg": trial.conditions["load_kg"],
            "angle_rad": trial.conditions["angle_rad"],
            "repeat": trial.conditions["repeat"],
            **trial.results,
        }
        for trial in trials
        if "steady_current_a" in trial.results
    ]
    estimated = [row for row in rows if row.get("reflected_load_kg") is not None]
    errors_kg = [number(row["reflected_load_kg"]) - number(row["load_kg"]) for row in estimated]
    summary: dict[str, Value] = {"rows": rows, "estimates": sum(row["load_current_a"] is not None for row in rows)}
    if errors_kg:
        summary |= {
            "mean_absolute_error_kg": sum(map(abs, errors_kg)) / len(errors_kg),
            "rms_error_kg": sqrt(sum(error_kg**2 for error_kg in errors_kg) / len(errors_kg)),
            "max_error_kg": max(map(abs, errors_kg)),
        }
    return summary


KIND = ExperimentKind(
    name="load-sweep",
    title="Load sweep",
    summary="Hangs one load after the other, and finds at each angle the current of the load alone by the zero-speed "
    "search. At 90 degrees it is compared with the weight that hangs there.",
    parameters=LoadSweepParameters,
    plan=_plan,
    refuse=_refuse,
    duration_s=_duration_s,
    summarise=_summarise,
    results=AT_REST_RESULTS,
    modes=a_current,
)
