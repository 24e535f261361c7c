"""The stability margin of a pair at rest: the force scale up to which a nudge dies away."""

from bench.config.configuration import BenchConfiguration
from bench.control.cycle import Reach
from bench.experiments.analysis.reflection_results import widest_swing
from bench.experiments.parts.pair_joints import PairJoints, PairPart
from bench.json_types import Value

NUDGE_RAD = 0.08
NUDGE_S = 0.15
DIE_AWAY_S = 1.0
WATCH_S = 1.0
CALM_S = 0.5  # without reflection, before each nudge
STAGE_S = CALM_S + 2.0 * NUDGE_S + DIE_AWAY_S + WATCH_S
LEAST = 0.5  # force scale that is tried first
GROWTH = 1.5
HALVINGS = 5


def ladder(largest: float) -> list[float]:
    """The force scales that are tried, the smallest first: an unstable pair may be calm again far beyond its margin."""
    scales = [min(LEAST, largest)]
    while scales[-1] < largest:
        scales.append(min(scales[-1] * GROWTH, largest))
    return scales


def margin(
    pair: PairJoints, configuration: BenchConfiguration, angle_rad: float, largest: float
) -> PairPart[dict[str, Value]]:
    """Raise the force scale, nudge the master each time, until the pair goes on swinging; then bisect.

    Args:
        pair: coupled, at rest.
        configuration: of the bench.
        angle_rad: which the operator holds.
        largest: force scale that is tried.

    Returns:
        stability_margin: the largest force scale below which no limit cycle was found.
        stability_margin_at_least: True where that is the largest that was to be tried; else one was found at
            `stability_margin_step` more.
    """
    calm = swinging = 0.0
    for force_scale in ladder(largest):
        if (yield from _swings(pair, configuration, angle_rad, force_scale)):
            swinging = force_scale
            break
        calm = force_scale
    for _ in range(HALVINGS if swinging else 0):
        middle = (calm + swinging) / 2.0
        if (yield from _swings(pair, configuration, angle_rad, middle)):
            swinging = middle
        else:
            calm = middle
    return {
        "stability_margin": calm,
        "stability_margin_at_least": not swinging,
        "stability_margin_step": max(swinging - calm, 0.0),
    }


def _swings(
    pair: PairJoints, configuration: BenchConfiguration, angle_rad: float, force_scale: float
) -> PairPart[bool]:
    rested = yield from pair.convey(CALM_S, Reach(angle_rad, CALM_S / 2.0), force_scale=1.0)
    about_n_m = rested[-1].reflected_n_m
    yield from pair.convey(NUDGE_S, Reach(angle_rad + NUDGE_RAD, NUDGE_S), force_scale, about_n_m)
    yield from pair.convey(NUDGE_S + DIE_AWAY_S, Reach(angle_rad, NUDGE_S), force_scale, about_n_m)
    watched = yield from pair.convey(WATCH_S, None, force_scale, about_n_m)
    return widest_swing(watched, configuration).is_limit_cycle
