"""Run-in: a new or freshly greased gear loses friction with the way it has turned."""

from dataclasses import dataclass
from math import exp

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class RunIn(Component):
    """Drive-side dry friction is F (1 + a exp(-s / s0)), s the way turned by the motor since the plant was made."""

    fraction: float = quantity("1", at_least=0, default=0.0)
    distance_rad: float = quantity("rad of the motor", above=0, default=1000.0)


@jitted
def run_in_scale(run_in: RunIn, travelled_rad: float) -> float:
    """Return dry friction after a way over that of a gear that is run in."""
    if run_in.fraction == 0.0:
        return 1.0
    return 1.0 + run_in.fraction * exp(-travelled_rad / run_in.distance_rad)
