"""A joint that strikes something stiff: seen by the motion that is missed, told by the momentum that was stopped.

    L = L0 + P,  P = J v / t        v the speed before, t the time in which stiff teeth and a stiff wall stop a joint
    L = far - e (L0 + P - far)      where that is more than the friction of the standing joint holds: it swings back

L0 is what was known, or the near end of the band that friction allows, eq. (1), where that is more; far is its other
end. Teeth that are wedged between wall and motor stay so: the load moves only where the current's band pushes it on.
"""

from math import isnan
from typing import NamedTuple

from compensator.motion.joint_model import JointUnderLoad
from compensator.motion.load_estimate import Branch, EstimatorSettings, EstimatorState, Hit, LoadEstimate, Observation

STOPPED_COUNTS = 4.0  # of its farthest place, within which a joint has arrived
SEEN_COUNTS = 3.0  # of motion that a current would have made, before its absence tells anything
SEEN_CYCLES = 12  # within which it has to be seen
CREEP_COUNTS = 1.5  # of way in a cycle: a joint that goes on faster has struck nothing
BEFORE_CYCLES = 4  # over which the speed before a hit is taken
HIT_CYCLES = 2  # with which the motion ends, and which the hit may already have slowed down
SWING_CYCLES = 6  # after a hit, in which it swings back
STOP_S = 0.008  # a fourth of a swing of 0.03 kg m2 on 1200 N m/rad
SWUNG_BACK = 0.5  # of what is more than friction holds; teeth and walls take the rest


class _Arrival(NamedTuple):
    """The end of a motion: cycles since, speed before it, the farthest place [rad], and by how much it is less now."""

    cycles: int
    speed_rad_s: float
    farthest_rad: float
    back_rad: float


def struck(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, observation: Observation
) -> Hit | None:
    """The hit that ended a motion just now, or the one that still holds; None where there is none."""
    if state.hit is not None and state.estimate.branch is Branch.STRUCK:
        return _held(settings, state.hit, observation)
    if isnan(state.known_a) or joint.inertia_a_s2_rad == 0.0 or state.still_cycles > settings.rest_cycles:
        return None
    for way, travel_rad in ((state.direction, _travel_rad(state)), (-state.direction, state.came_rad)):
        arrival = _arrival(settings, state, way) if travel_rad > settings.free_play_rad else None
        speed_rad_s = None if arrival is None else _stopped_rad_s(joint, settings, state, way, arrival)
        if arrival is not None and speed_rad_s is not None:
            return _hit(joint, settings, state, way, arrival, speed_rad_s)
    return None


def estimate(joint: JointUnderLoad, state: EstimatorState, hit: Hit, held_a: float) -> LoadEstimate:
    """What the hit left, or what was known since, as far as the present current lets friction hold it."""
    near_a, far_a = _band_a(joint, state.currents_a[-1], hit.way)
    load_a = held_a if hit.cycles else hit.load_a
    given_a = hit.way * min(max(hit.way * load_a, hit.way * near_a), max(hit.way * far_a, hit.way * near_a))
    return LoadEstimate(given_a, max(abs(given_a - near_a), abs(given_a - far_a)), Branch.STRUCK)


def _held(settings: EstimatorSettings, hit: Hit, observation: Observation) -> Hit | None:
    """The hit a cycle later: teeth stay wedged until the joint moves on, or back once it has swung."""
    ahead_rad = hit.way * (observation.position_rad - hit.position_rad)
    swings = hit.cycles < SWING_CYCLES
    back_rad = hit.holds_rad if swings else STOPPED_COUNTS * settings.count_rad
    if not -back_rad <= ahead_rad <= hit.holds_rad:
        return None
    place_rad = observation.position_rad if swings else hit.position_rad
    return hit._replace(position_rad=place_rad, cycles=hit.cycles + 1)


def _arrival(settings: EstimatorSettings, state: EstimatorState, way: float) -> _Arrival | None:
    """Where and how fast the motion ended that went this way; None where it goes on, or none was seen."""
    places = [way * position_rad for position_rad in state.positions_rad]
    if len(places) <= HIT_CYCLES + BEFORE_CYCLES or places[-1] - places[-2] > CREEP_COUNTS * settings.count_rad:
        return None
    farthest_rad, stop_rad = max(places), STOPPED_COUNTS * settings.count_rad
    first = next(at for at, place in enumerate(places) if place >= farthest_rad - stop_rad)
    begun = first - HIT_CYCLES - BEFORE_CYCLES
    if begun < 0 or not 1 <= len(places) - 1 - first <= SEEN_CYCLES:
        return None
    speed_rad_s = (places[first - HIT_CYCLES] - places[begun]) / (BEFORE_CYCLES * settings.period_s)
    back_rad = farthest_rad - places[-1]
    # what swings back goes no faster than it came
    if speed_rad_s <= 0.0 or back_rad > _holds_rad(settings, speed_rad_s):
        return None
    return _Arrival(len(places) - 1 - first, speed_rad_s, farthest_rad, back_rad)


def _stopped_rad_s(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, way: float, arrival: _Arrival
) -> float | None:
    """The speed that was stopped; None where momentum, current and the load that is known do not miss any motion."""
    first = len(state.positions_rad) - 1 - arrival.cycles
    before = first - HIT_CYCLES
    # teeth that meet stop a motor, too; and an arm that nothing stops flies on from a motor that stands
    play_rad = settings.free_play_rad
    touches_rad = play_rad / 2.0 - min(STOPPED_COUNTS * settings.count_rad, play_rad / 4.0)
    if any(way * (arm.motor_rad - arm.angle_rad) < touches_rad for arm in state.arms[before - BEFORE_CYCLES : before]):
        return None
    speed_rad_s, way_rad, stopped_rad_s = arrival.speed_rad_s, 0.0, 0.0
    held_a = state.known_a + joint.gravity_at(state.positions_rad[-1])
    friction_a = joint.friction_a(way * speed_rad_s, way)
    slowing_a = joint.gear_loss.motor_current_a(held_a, way) + friction_a
    slowing_a += way * 3.0 * joint.friction_scatter * abs(friction_a)
    # from the middle of the cycles that the speed is from
    for at in range(before - BEFORE_CYCLES // 2, first + arrival.cycles + 1):
        gained_rad_s = way * (state.currents_a[at] - slowing_a) * settings.period_s / joint.inertia_a_s2_rad
        speed_rad_s = max(speed_rad_s + gained_rad_s, 0.0)
        stopped_rad_s = speed_rad_s if at <= first else stopped_rad_s
        way_rad += speed_rad_s * settings.period_s if at > first else 0.0
    went_rad = arrival.farthest_rad - way * state.positions_rad[first]
    return stopped_rad_s if way_rad - went_rad > SEEN_COUNTS * settings.count_rad else None


def _hit(
    joint: JointUnderLoad, settings: EstimatorSettings, state: EstimatorState, way: float, arrival: _Arrival,
    stopped_rad_s: float,
) -> Hit:  # fmt: skip
    """What a momentum leaves of itself in wedged teeth."""
    stood = state.currents_a[-arrival.cycles - 1 :]
    near_a, far_a = _band_a(joint, sum(stood) / len(stood), way)
    held_a = state.known_a + joint.gravity_at(state.positions_rad[-1])
    least = max(way * held_a, way * near_a)
    peak, most = least + joint.inertia_a_s2_rad * stopped_rad_s / STOP_S, max(way * far_a, least)
    left = peak if peak <= most else max(most - SWUNG_BACK * (peak - most), least)
    place_rad = way * (arrival.farthest_rad - arrival.back_rad)
    return Hit(way, way * left, place_rad, _holds_rad(settings, arrival.speed_rad_s))


def _band_a(joint: JointUnderLoad, current_a: float, way: float) -> tuple[float, float]:
    """Loads of a standing joint that is about to move on, and back [A]."""
    return joint.about_to_move_a(current_a, way), joint.about_to_move_a(current_a, -way)


def _holds_rad(settings: EstimatorSettings, speed_rad_s: float) -> float:
    return HIT_CYCLES * settings.period_s * speed_rad_s + STOPPED_COUNTS * settings.count_rad


def _travel_rad(state: EstimatorState) -> float:
    return abs(state.extreme_rad - state.turned_rad)
