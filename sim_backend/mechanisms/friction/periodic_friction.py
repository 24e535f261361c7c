"""Dry friction that varies with the angle: an eccentric wheel, a bent shaft, a bearing that binds once a turn."""

from dataclasses import dataclass
from math import cos

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class PeriodicFriction(Component):
    """Drive-side dry friction is F (1 + a cos(n q - p)), q the joint angle.

    An eccentric output wheel has n = 1, the motor shaft n = gear ratio, a tooth n = teeth.
    """

    fraction: float = quantity("1", at_least=0, at_most=1, default=0.0)
    cycles_per_turn: float = quantity("1", above=0, default=1.0)
    phase_rad: float = quantity("rad", default=0.0)


@jitted
def periodic_scale(periodic: PeriodicFriction, angle_rad: float) -> float:
    """Return dry friction at a joint angle over its mean."""
    if periodic.fraction == 0.0:
        return 1.0
    return 1.0 + periodic.fraction * cos(periodic.cycles_per_turn * angle_rad - periodic.phase_rad)
