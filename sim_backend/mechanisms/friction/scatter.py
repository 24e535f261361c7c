"""How far dry friction strays from its nominal value: from stop to stop, and along the path."""

from dataclasses import dataclass
from math import exp, sqrt

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted
from sim_backend.plant.randomness import draw
from sim_backend.plant.state import State


@dataclass(frozen=True, kw_only=True)
class Scatter(Component):
    """How far drive-side dry friction strays from its nominal value.

    Static friction is drawn anew at each stop. Coulomb friction wanders along the path as a stationary
    Gauss-Markov process in the distance travelled.
    """

    static_fraction: float = quantity("1, standard deviation", at_least=0, at_most=0.2, default=0.0)
    coulomb_fraction: float = quantity("1, standard deviation", at_least=0, at_most=0.2, default=0.0)
    coulomb_length_rad: float = quantity("rad of the joint", above=0, default=0.05)


@jitted
def draw_static_factor(state: State, scatter: Scatter) -> float:
    """Return this stop's static friction over the nominal one, within three standard deviations."""
    if scatter.static_fraction == 0.0:
        return 1.0
    return 1.0 + scatter.static_fraction * min(max(draw(state), -3.0), 3.0)


@jitted
def wander(state: State, scatter: Scatter, distance_rad: float) -> None:
    """Move the Coulomb factor on by a distance travelled [rad of the joint]; drawn 16 times per correlation length."""
    if scatter.coulomb_fraction == 0.0:
        return
    state.wandered_rad += distance_rad
    if state.wandered_rad < scatter.coulomb_length_rad / 16.0:
        return
    kept = exp(-state.wandered_rad / scatter.coulomb_length_rad)
    fresh = scatter.coulomb_fraction * sqrt(1.0 - kept * kept) * draw(state)
    state.coulomb_factor = max(1.0 + kept * (state.coulomb_factor - 1.0) + fresh, 0.2)
    state.wandered_rad = 0.0
