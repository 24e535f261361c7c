"""Elasticity of the transmission behind the teeth: a shaft that winds up, a flexible spline, a belt."""

from dataclasses import dataclass

from sim_backend.component import Component, quantity
from sim_backend.contact import Gear
from sim_backend.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Shaft(Component):
    """A massless spring in series with the teeth.

        1 / k = 1 / k_teeth + compliance,    c / k as for the teeth alone

    The material's loss is proportional to its stiffness, so that teeth and shaft in series are one spring and one
    damper. Compliance 0 is a rigid shaft.
    """

    compliance_rad_n_m: float = quantity("rad/(N m) at the joint", at_least=0, default=0.0)


@jitted
def stiffness(gear: Gear, shaft: Shaft) -> float:
    """Return the stiffness of teeth and shaft in series [N m/rad]."""
    if shaft.compliance_rad_n_m == 0.0:
        return gear.stiffness_n_m_rad
    return gear.stiffness_n_m_rad / (1.0 + shaft.compliance_rad_n_m * gear.stiffness_n_m_rad)


@jitted
def damping(gear: Gear, shaft: Shaft) -> float:
    """Return the damping of teeth and shaft in series [N m s/rad]."""
    if shaft.compliance_rad_n_m == 0.0:
        return gear.damping_n_m_s_rad
    return gear.damping_n_m_s_rad / (1.0 + shaft.compliance_rad_n_m * gear.stiffness_n_m_rad)
