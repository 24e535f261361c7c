"""Dry friction that differs with the direction of motion (worn or skewed teeth, a preloaded seal)."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class CoulombAsymmetry(Component):
    """Drive-side dry friction is (1 + f) F in the positive and (1 - f) F in the negative direction."""

    fraction: float = quantity("1", at_least=-1, at_most=1, default=0.0)


@jitted
def dry_scale(asymmetry: CoulombAsymmetry, direction: float) -> float:
    """Return dry friction in a direction (+1, -1) over its mean."""
    return 1.0 + asymmetry.fraction * direction
