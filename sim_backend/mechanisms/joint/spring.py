"""A spring across the joint: a balance spring, or a cable that is bent as the joint turns."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Spring(Component):
    """Torque on the arm T = -k (q - q0)."""

    stiffness_n_m_rad: float = quantity("N m/rad", at_least=0, default=0.0)
    rest_rad: float = quantity("rad", default=0.0)


@jitted
def spring_torque(spring: Spring, angle_rad: float) -> float:
    """Return the spring's torque on the arm [N m]."""
    return -spring.stiffness_n_m_rad * (angle_rad - spring.rest_rad)


@jitted
def spring_energy(spring: Spring, angle_rad: float) -> float:
    """Return the energy in the spring [J]."""
    return 0.5 * spring.stiffness_n_m_rad * (angle_rad - spring.rest_rad) ** 2
