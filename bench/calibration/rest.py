"""What load sweeps tell of the joint at rest: asymmetry, gear loss and scatter, and the friction under each load."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from math import isfinite, nan, sin
from typing import NamedTuple

from bench.config.reflected_load import LEAST_LEVER, arm_angle_rad, load_current_a
from bench.config.rig import Rig
from bench.config.sections import RestSettings
from bench.errors import ConfigurationError
from bench.store import Trial
from compensator.errors import CalibrationError
from compensator.rest.breakaway_fit import Breakaway, BreakawayFit, fit
from compensator.rest.rest_calibration import RestPoint, calibrate


class SearchedTrial(NamedTuple):
    """One trial at rest with its searches."""

    trial_id: int
    point: RestPoint


class ToldAtRest(NamedTuple):
    """What load sweeps told.

    Attributes:
        settings: the corrections of eqs (9), (10); None where they did not tell.
        friction_a: F_load [A], without what a moment adds, under each load [kg].
        why_not: why there are no settings, in words.
    """

    settings: RestSettings | None
    friction_a: dict[float, float]
    trial_ids: list[int]
    why_not: str


def searched_trials(trials: Iterable[Trial], rig: Rig) -> list[SearchedTrial]:
    """Those that hold enough breakaways to show their scatter.

    Raises:
        ConfigurationError: the rig leaves out what a load current needs.
    """
    found = []
    for trial in trials:
        breakaways, angle_rad = trial.results.get("breakaways"), trial.conditions.get("angle_rad")
        if not breakaways or not isinstance(angle_rad, float | int) or trial.conditions.get("balanced"):
            continue
        fitted = fit([Breakaway(*one) for one in breakaways])
        if isfinite(fitted.scatter_a):
            load_kg = float(trial.conditions["load_kg"])
            load_a = _known_load_a(load_kg, angle_rad, fitted, rig)
            point = RestPoint(load_a, load_kg, fitted, _moved_kg_m2(load_kg, load_a, rig))
            found.append(SearchedTrial(trial.id, point))
    return found


def _moved_kg_m2(load_kg: float, load_a: float, rig: Rig) -> float:
    """Inertia that a breakaway sets in motion: the rotor's, and the arm's where the teeth touch; NaN if not known."""
    rotor, ratio, arm, length_m = (
        rig.motor.rotor_inertia_kg_m2, rig.gear.ratio, rig.arm.inertia_kg_m2, rig.arm.length_m,
    )  # fmt: skip
    if rotor is None or ratio is None or arm is None or length_m is None:
        return nan
    touches = load_a != 0.0 or rig.gear.backlash_rad == 0.0
    return rotor * ratio**2 + (arm + load_kg * length_m**2 if touches else 0.0)


def _known_load_a(load_kg: float, angle_rad: float, fitted: BreakawayFit, rig: Rig) -> float:
    """Current of a known load [A], where the arm truly was; 0 straight down, where the teeth carry nothing."""
    if abs(sin(angle_rad)) < LEAST_LEVER:
        return 0.0
    about_a = load_current_a(load_kg, angle_rad, rig)
    if not isfinite(fitted.position_rad):
        return about_a
    return load_current_a(load_kg, arm_angle_rad(fitted.position_rad, about_a, rig), rig)


def rest_of(trials: Sequence[Trial], rig: Rig) -> ToldAtRest:
    """What the trials tell, or why they do not."""
    try:
        searched = searched_trials(trials, rig)
        told = calibrate([one.point for one in searched])
    except (CalibrationError, ConfigurationError) as error:
        return ToldAtRest(None, {}, [], str(error))
    friction_a: dict[float, list[float]] = defaultdict(list)
    for one in searched:
        friction_a[one.point.load_kg].append(told.estimate(one.point.found).friction_current_a.value)
    means = {load_kg: sum(values) / len(values) for load_kg, values in sorted(friction_a.items())}
    return ToldAtRest(RestSettings(**asdict(told)), means, [one.trial_id for one in searched], "")
