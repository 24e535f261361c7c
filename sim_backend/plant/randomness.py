"""The plant's own randomness: friction differs from stop to stop and along the path, and the sensor is noisy."""

from dataclasses import dataclass
from math import cos, exp, log, pi, sqrt

import numpy as np

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted
from sim_backend.plant.state import State

_INCREMENT = np.uint64(0x9E3779B97F4A7C15)
_MIX_A = np.uint64(0xBF58476D1CE4E5B9)
_MIX_B = np.uint64(0x94D049BB133111EB)


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
def uniform(key: np.uint64) -> float:
    """Return the number in (0, 1] that belongs to a key (splitmix64: Steele, Lea, Flood 2014)."""
    z = (key ^ (key >> np.uint64(30))) * _MIX_A
    z = (z ^ (z >> np.uint64(27))) * _MIX_B
    z = z ^ (z >> np.uint64(31))
    return (float(z >> np.uint64(11)) + 1.0) * (1.0 / 9007199254740992.0)


@jitted
def normal(key: np.uint64) -> float:
    """Return the standard normal number of a key (Box and Muller); the next key of the stream is two on."""
    return sqrt(-2.0 * log(uniform(key))) * cos(2.0 * pi * uniform(key + _INCREMENT))


@jitted
def draw(state: State) -> float:
    """Return the next standard normal number of the plant's stream."""
    state.random = state.random + _INCREMENT + _INCREMENT
    return normal(state.random)


@jitted
def sensor_noise(state: State) -> float:
    """Return this moment's standard normal number; measuring more often does not change the plant."""
    return normal(state.sensor_seed + np.uint64(2 * state.steps) * _INCREMENT)


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
