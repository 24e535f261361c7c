"""At which angles loads are searched for a calibration at rest, and whether both sides were.

Loads on one side cannot separate friction that differs by direction from the gear's loss under a load. On one side the
two add, on the other they subtract. `python -m tests.figures.intervals` shows the error that one side alone leaves.
"""

from collections.abc import Sequence
from math import pi

from bench.config.configuration import BenchConfiguration
from bench.store import Trial

MARGIN_RAD = 0.05  # beyond what a search moves the joint
FLATTEST_RAD = 0.25  # of either side: below, hardly any load reaches the teeth


def sides_rad(configuration: BenchConfiguration) -> list[float]:
    """Level on both sides, or as far as the limits let a search go; without a side that they leave too flat.

    Both are missing where neither goes: then level, which the sweep refuses with its limits.
    """
    limits, spare_rad = configuration.limits, configuration.search.excursion_rad + MARGIN_RAD
    reaches_rad = (limits.position_max_rad - spare_rad, -limits.position_min_rad - spare_rad)
    found = [
        side * round(min(pi / 2.0, reach_rad), 4)
        for side, reach_rad in zip((1.0, -1.0), reaches_rad, strict=True)
        if reach_rad >= FLATTEST_RAD
    ]
    return found or [round(pi / 2.0, 4)]


def one_sided(trials: Sequence[Trial]) -> str:
    """Why an estimate on the other side is to be doubted; "" where loads were searched on both, or nowhere."""
    searched = [trial for trial in trials if trial.results.get("breakaways")]
    angles_rad = [float(trial.conditions.get("angle_rad", 0.0)) for trial in searched]
    sides = {angle_rad > 0.0 for angle_rad in angles_rad if abs(angle_rad) >= FLATTEST_RAD}
    return ONE_SIDED if len(sides) == 1 else ""


ONE_SIDED = (
    "Loads were searched at rest on one side alone: on the other side an estimate errs by more than its interval says. "
    "Add a load-sweep at an angle there, and fit again"
)
