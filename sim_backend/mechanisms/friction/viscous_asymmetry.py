"""Viscous friction that differs with the direction of motion (an oil wedge that forms one way only)."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class ViscousAsymmetry(Component):
    """Drive-side viscous friction is (1 + f) B in the positive and (1 - f) B in the negative direction."""

    fraction: float = quantity("1", at_least=-1, at_most=1, default=0.0)


@jitted
def viscous_scale(asymmetry: ViscousAsymmetry, speed_rad_s: float) -> float:
    """Return viscous friction at a speed over its mean; 1 at rest, where it does nothing."""
    if speed_rad_s > 0.0:
        return 1.0 + asymmetry.fraction
    if speed_rad_s < 0.0:
        return 1.0 - asymmetry.fraction
    return 1.0
