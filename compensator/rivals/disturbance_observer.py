"""A disturbance observer with one friction curve: what inertia and friction at the measured speed leave is the load.

K. Ohnishi, M. Shibata, T. Murakami, IEEE/ASME Trans. Mechatronics 1 (1996), 56. At rest all friction that holds the
joint counts as load.
"""

from typing import NamedTuple

from compensator.motion.load_estimate import LoadEstimate, Observation
from compensator.rivals.load_observer import ObserverState, SpeedState, follow, observe
from compensator.rivals.rival import Knowledge, Rival, estimate


class State(NamedTuple):
    """Readings, and the observer."""

    speed: SpeedState = SpeedState()
    observer: ObserverState = ObserverState()


def begin(_knowledge: Knowledge) -> State:
    """At rest, without a load."""
    return State()


def advance(knowledge: Knowledge, state: State, observation: Observation) -> tuple[State, LoadEstimate]:
    """One control cycle."""
    speed, speed_rad_s = follow(state.speed, knowledge.settings, observation.position_rad)
    friction_a = float(knowledge.fixed.sliding_a(speed_rad_s * knowledge.ratio))
    observer = observe(knowledge, state.observer, speed_rad_s, observation.current_a, friction_a)
    found = estimate(observation, friction_a, moving=speed_rad_s != 0.0)
    return State(speed, observer), found._replace(load_current_a=observer.load_a)


RIVAL = Rival("disturbance-observer", "disturbance observer", "Ohnishi et al. 1996", begin, advance, filters=True)
