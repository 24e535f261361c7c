"""One trial at rest: go to an angle, settle, note the uncompensated current, search, note the compensated one."""

from math import pi
from typing import Any

from bench.configuration import BenchConfiguration
from bench.experiments.joint import Joint
from bench.experiments.reflected_load import reflected_load_kg
from bench.loop import Procedure
from compensator.zero_speed_search import Phase, SearchState

SEARCH_S = 4.0  # of one search, roughly
MOVES_S = 3.0  # to the angle and back, roughly
RIGHT_ANGLE_RAD = pi / 2
FOUND = ("min_current_a", "max_current_a", "load_current_a", "friction_current_a")


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

    Results:
        steady_current_a: uncompensated, as the position servo happened to leave it (Fig. 4).
        min_current_a, max_current_a: at which the joint just moved, mean of all searches.
        load_current_a, friction_current_a: eqs (9), (10), mean of all searches.
        load_currents_a: eq. (9) of each search.
        reflected_load_kg: what the load current amounts to at this angle; None near angle 0.
        search_failure: why there is no estimate; "" where there is. Without one all but the first are None.
    """
    joint = Joint(configuration)
    yield from joint.wake()
    yield from joint.move(0.0)
    yield from joint.settle(0.0)
    yield from joint.move(angle_rad, approach_rad_s)
    steady = yield from joint.settle(angle_rad)
    results: dict[str, Any] = {"steady_current_a": steady.current_a, "steady_position_rad": steady.position_rad}
    found: list[SearchState] = []
    for _ in range(searches):
        state = yield from joint.search(angle_rad)
        if state.phase is not Phase.DONE:
            yield from joint.move(0.0)
            return results | _no_estimate(state)
        found.append(state)
        yield from joint.reflect(angle_rad, state.estimate().load_current_a)
    yield from joint.move(0.0)
    return results | _estimate(found, angle_rad, configuration)


def _no_estimate(state: SearchState) -> dict[str, Any]:
    names = (*FOUND, "load_currents_a", "reflected_load_kg")
    return {**dict.fromkeys(names), "search_failure": state.reason.value if state.reason else state.phase.value}


def _estimate(found: list[SearchState], angle_rad: float, configuration: BenchConfiguration) -> dict[str, Any]:
    rows = [(state.min_current_a, state.max_current_a, *state.estimate()) for state in found]
    means = {name: sum(values) / len(values) for name, values in zip(FOUND, zip(*rows, strict=True), strict=True)}
    return {
        **means,
        "load_currents_a": [state.estimate().load_current_a for state in found],
        "reflected_load_kg": reflected_load_kg(means["load_current_a"], angle_rad, configuration.rig),
        "search_failure": "",
    }
