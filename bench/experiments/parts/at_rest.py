"""One trial at rest: go to an angle, settle, note the uncompensated current, search, note the compensated one."""

from math import isnan, pi

from bench.config.configuration import BenchConfiguration
from bench.config.reflected_load import arm_angle_rad, reflected_load_kg
from bench.control.cycle import Procedure
from bench.experiments.analysis.rest_estimate import RestFinding, finding
from bench.experiments.parts.joint import Joint
from bench.experiments.parts.search import Found
from bench.json_types import Value

SEARCH_S = {"paper": 6.0, "improved": 2.5}  # of one search, roughly
MOVES_S = 3.0  # to the angle and back, roughly
RIGHT_ANGLE_RAD = pi / 2
_STEADY = {
    "steady_current_a": "uncompensated, as the position servo happened to leave it (Fig. 4 of the paper)",
    "steady_position_rad": "where the joint stood then",
}
_SEARCHED = {
    "min_current_a": "at which the joint just gives way backwards, which is down at 90 degrees; mean of all searches",
    "max_current_a": "at which the joint just gives way forwards, which is up at 90 degrees; mean of all searches",
    "load_current_a": "of the load alone, I_load: half the sum of these two (paper, eq. 9); corrected where known "
    "loads have told how",
    "friction_current_a": "friction at that load, F_load: half their difference (paper, eq. 10); corrected likewise",
    "load_currents_a": "of the load alone, by each search",
    "load_interval_a": "95 %, [low, high] of `load_current_a`; null where the searches do not tell",
    "friction_interval_a": "95 %, [low, high] of `friction_current_a`; null where the searches do not tell",
    "arm_angle_rad": "of the arm behind the free play during the searches, as far as the sensor before it tells",
    "reflected_load_kg": "what the current of the load amounts to at that angle; null near angle 0",
    "reflected_interval_kg": "95 %, [low, high] of it",
    "breakaways": "of each breakaway: direction (1, -1), current [A], rate of the current [A/s], position [rad]",
    "search_s": "time of one search, mean",
    "search_travel_rad": "motion of one search, mean",
}
AT_REST_RESULTS = {
    **_STEADY,
    **_SEARCHED,
    "search_failure": "why there is no estimate; empty where there is one. Without it, all but the first two are null",
}
"""What the results of a trial at rest are."""


def duration_s(configuration: BenchConfiguration, searches: int) -> float:
    """Of one trial, roughly [s]."""
    return MOVES_S + SEARCH_S[configuration.search.method] * searches


def measure_at_rest(
    configuration: BenchConfiguration, angle_rad: float, searches: int, approach_rad_s: float | None = None
) -> Procedure:
    """The procedure. It starts and ends at angle 0, where the joint may be left without power.

    Args:
        configuration: of the bench.
        angle_rad: where to measure.
        searches: zero-speed searches, one after the other. Friction is a little different each time that the joint
            comes to rest; the mean is not.
        approach_rad_s: speed of the way there; that of the configuration where None.

    Results: `AT_REST_RESULTS`.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    yield from joint.rest_at(0.0)
    steady = yield from joint.rest_at(angle_rad, approach_rad_s)
    results: dict[str, Value] = {"steady_current_a": steady.current_a, "steady_position_rad": steady.position_rad}
    found: list[Found] = []
    for _ in range(searches):
        one = yield from joint.search(angle_rad)
        found.append(one)
        if one.failure:
            yield from joint.move(0.0)
            return results | dict.fromkeys(_SEARCHED) | {"search_failure": one.failure}
        told = finding(found, configuration)
        yield from joint.reflect(angle_rad, told.load_current_a, told.half_width_a)
    yield from joint.move(0.0)
    return results | _estimate(found, steady.position_rad, configuration)


def _estimate(found: list[Found], steady_rad: float, configuration: BenchConfiguration) -> dict[str, Value]:
    whole = finding(found, configuration)
    stood_rad = steady_rad if isnan(whole.position_rad) else whole.position_rad
    angle_rad = arm_angle_rad(stood_rad, whole.load_current_a, configuration.rig)
    values = (
        whole.min_current_a,
        whole.max_current_a,
        whole.load_current_a,
        whole.friction_current_a,
        [finding([one], configuration).load_current_a for one in found],
        whole.load_interval_a,
        whole.friction_interval_a,
        angle_rad,
        reflected_load_kg(whole.load_current_a, angle_rad, configuration.rig),
        _reflected_interval(whole, angle_rad, configuration),
        [list(breakaway) for one in found for breakaway in one.breakaways],
        sum(one.seconds for one in found) / len(found),
        sum(one.travel_rad for one in found) / len(found),
    )
    return {**dict(zip(_SEARCHED, values, strict=True)), "search_failure": ""}


def _reflected_interval(whole: RestFinding, angle_rad: float, configuration: BenchConfiguration) -> list[float] | None:
    ends_a = whole.load_interval_a or []
    ends_kg = [reflected_load_kg(end_a, angle_rad, configuration.rig) for end_a in ends_a]
    return sorted(end_kg for end_kg in ends_kg if end_kg is not None) or None
