"""Drag with the square of the speed: oil that is churned, air that is fanned."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Drag(Component):
    """Turbulent drag at the motor shaft: T = c w |w|."""

    coefficient_n_m_s2_rad2: float = quantity("N m s2/rad2", at_least=0, default=0.0)


@jitted
def drag_slope(drag: Drag, speed_rad_s: float) -> float:
    """Return drag torque over speed [N m s/rad], so that it can be integrated as viscous friction is."""
    return drag.coefficient_n_m_s2_rad2 * abs(speed_rad_s)
