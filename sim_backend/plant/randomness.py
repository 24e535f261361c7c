"""The randomness of the plant itself: streams that are told by a seed, whatever else happens."""

from math import cos, log, pi, sqrt

import numpy as np

from sim_backend.plant.jit import jitted
from sim_backend.plant.state import State

_INCREMENT = np.uint64(0x9E3779B97F4A7C15)
_MIX_A = np.uint64(0xBF58476D1CE4E5B9)
_MIX_B = np.uint64(0x94D049BB133111EB)


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
