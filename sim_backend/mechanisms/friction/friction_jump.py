"""Dry friction that jumps between two values and back: a seal lip that turns over, a bearing cage that flips."""

from dataclasses import dataclass

import numpy as np

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted
from sim_backend.plant.randomness import uniform
from sim_backend.plant.state import State

_STREAM = np.uint64(0xD1B54A32D192ED03)
_INCREMENT = np.uint64(0x9E3779B97F4A7C15)


@dataclass(frozen=True, kw_only=True)
class FrictionJump(Component):
    """Drive-side dry friction is F in one state and (1 + f) F in the other.

    The state flips at moments that nothing announces, on average after so long (a random telegraph; torque jumps of
    this kind are known of the bearings of momentum wheels). The moments take nothing from the plant's other
    randomness: with the jump or without, everything else happens alike.
    """

    fraction: float = quantity("1", at_least=-1, at_most=5, default=0.0)
    mean_interval_s: float = quantity("s", above=0, default=5.0)


@jitted
def jump_scale(jump: FrictionJump, state: State) -> float:
    """Return dry friction over that of the first state."""
    return 1.0 + jump.fraction if state.jumped else 1.0


@jitted
def flip(jump: FrictionJump, state: State, step_s: float) -> None:
    """Let the state flip, if this step is the moment."""
    if jump.fraction == 0.0:
        return
    key = (state.sensor_seed ^ _STREAM) + np.uint64(state.steps) * _INCREMENT
    if uniform(key) * jump.mean_interval_s < step_s:
        state.jumped = not state.jumped
