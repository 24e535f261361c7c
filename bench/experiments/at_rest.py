"""One trial at rest: go to an angle, settle, note the uncompensated current, search, note the compensated one."""

from math import pi
from typing import Any

from bench.configuration import BenchConfiguration
from bench.experiments.joint import Joint, Steady
from bench.experiments.reflected_load import reflected_load_kg
from bench.loop import Procedure
from compensator.zero_speed_search import Phase, SearchState

SECONDS = 7.0  # of a move, a search and the way back, roughly
RIGHT_ANGLE_RAD = pi / 2


def measure_at_rest(
    configuration: BenchConfiguration, angle_rad: float, approach_rad_s: float | None = None
) -> Procedure:
    """The procedure. It starts and ends at angle 0, where the joint may be left without power.

    Args:
        configuration: of the bench.
        angle_rad: where to measure.
        approach_rad_s: speed of the way there; that of the configuration where None.

    Results:
        steady_current_a: uncompensated, as the position servo happened to leave it (Fig. 4).
        min_current_a, max_current_a: at which the joint just moved.
        load_current_a, friction_current_a: eqs (9), (10).
        reflected_load_kg: what the load current amounts to at this angle; None near angle 0.
        search_failure: why there is no estimate; "" where there is. Without it the five above are None.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    yield from joint.move(0.0)
    yield from joint.settle(0.0)
    yield from joint.move(angle_rad, approach_rad_s)
    steady = yield from joint.settle(angle_rad)
    began = yield from joint.search(angle_rad)
    results = _results(configuration, angle_rad, steady, began)
    if began.phase is Phase.DONE:
        yield from joint.reflect(angle_rad, began.estimate().load_current_a)
    yield from joint.move(0.0)
    return results


def _results(
    configuration: BenchConfiguration, angle_rad: float, steady: Steady, search: SearchState
) -> dict[str, Any]:
    results: dict[str, Any] = {"steady_current_a": steady.current_a, "steady_position_rad": steady.position_rad}
    if search.phase is not Phase.DONE:
        names = ("min_current_a", "max_current_a", "load_current_a", "friction_current_a", "reflected_load_kg")
        reason = search.reason.value if search.reason else search.phase.value
        return results | dict.fromkeys(names) | {"search_failure": reason}
    load_a, friction_a = search.estimate()
    return results | {
        "min_current_a": search.min_current_a,
        "max_current_a": search.max_current_a,
        "load_current_a": load_a,
        "friction_current_a": friction_a,
        "reflected_load_kg": reflected_load_kg(load_a, angle_rad, configuration.rig),
        "search_failure": "",
    }
