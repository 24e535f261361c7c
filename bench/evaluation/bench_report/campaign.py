"""What is run, and what is taken from it. A baseline holds for one campaign: a change here needs a new one."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from typing import Any

from bench.config.configuration import default_configuration
from bench.control.drive_factory import with_seed
from bench.evaluation.paper.measurements import Measurement, measure, own_store, quietly
from bench.json_types import Value

LOAD_KG = 0.1
STEPS = Measurement("steps", {"repeats": 3, "load_kg": LOAD_KG})
LOADS = Measurement("load-sweep", {"loads_kg": (0.0, 0.05, LOAD_KG), "angles_rad": (pi / 2,)})


@dataclass(frozen=True, slots=True)
class Metric:
    """One number of one seed.

    Attributes:
        name: with the unit at its end.
        title: in words.
        measurement: the experiment.
        of: from the summary of the experiment.
        lower_is_better: False where neither is: any change is told, whichever way.
    """

    name: str
    title: str
    measurement: Measurement
    of: Callable[[Mapping[str, Any]], float]
    lower_is_better: bool = True


METRICS = (
    Metric(
        "steps_load_current_spread_a",
        "Spread of the load's current over repeated steps",
        STEPS,
        lambda found: float(found["spread_load_current_a"]),
    ),
    Metric(
        "steps_load_error_kg",
        "Error of the mean reflected load after steps",
        STEPS,
        lambda found: abs(float(found["mean_reflected_load_kg"]) - LOAD_KG),
    ),
    Metric(
        "loads_mean_error_kg",
        "Mean absolute error of the reflected load over loads",
        LOADS,
        lambda found: float(found["mean_absolute_error_kg"]),
    ),
    Metric(
        "loads_search_time_s",
        "Time of the searches at rest",
        LOADS,
        lambda found: float(sum(row["search_s"] for row in found["rows"])),
    ),
    Metric(
        "loads_search_travel_rad",
        "Way that the searches move the joint",
        LOADS,
        lambda found: float(sum(row["search_travel_rad"] for row in found["rows"])),
    ),
    Metric(
        "steps_steady_current_a",
        "Current that the servo leaves standing after steps",
        STEPS,
        lambda found: float(found["mean_steady_current_a"]),
        lower_is_better=False,
    ),
    Metric(
        "loads_friction_current_a",
        "Friction that the searches find",
        LOADS,
        lambda found: float(sum(row["friction_current_a"] for row in found["rows"]) / len(found["rows"])),
        lower_is_better=False,
    ),
)


@dataclass(frozen=True, slots=True)
class SeedValues:
    """What one seed gave.

    Attributes:
        values: of each metric, by name.
        failures: why an experiment gave none, in words.
    """

    seed: int
    values: dict[str, float]
    failures: tuple[str, ...] = ()


def fingerprint() -> dict[str, Value]:
    """What a baseline must have been made with, JSON-able."""
    kinds = {one.kind: dict(one.parameters) for one in (STEPS, LOADS)}
    listed = {kind: {key: _plain(value) for key, value in values.items()} for kind, values in kinds.items()}
    return {"experiments": listed, "metrics": metric_names()}


def metric_names() -> list[str]:
    """Of every seed of a baseline."""
    return [metric.name for metric in METRICS]


def run_seed(seed: int) -> SeedValues:
    """Run the campaign once on the simulated bench of the paper."""
    seeded = with_seed(default_configuration(), seed)
    values: dict[str, float] = {}
    failures = []
    with own_store() as store:
        for measurement in (STEPS, LOADS):
            try:
                found = measure(seeded, store, measurement, quietly).results
                values |= {one.name: one.of(found) for one in METRICS if one.measurement is measurement}
            except Exception as error:  # whatever it is, it is a result: the report says it
                failures.append(f"{measurement.kind}, seed {seed}: {str(error) or type(error).__name__}")
    return SeedValues(seed, values, tuple(failures))


def _plain(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value
