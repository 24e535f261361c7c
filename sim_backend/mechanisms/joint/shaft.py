"""Elasticity of the transmission behind the teeth: a shaft that winds up, a flexible spline, a belt."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity


@dataclass(frozen=True, kw_only=True)
class Shaft(Component):
    """A massless spring in series with the teeth.

        1 / k = 1 / k_teeth + compliance,    c / k as for the teeth alone

    The material's loss is proportional to its stiffness, so that teeth and shaft in series are one spring and one
    damper. Compliance 0 is a rigid shaft.
    """

    compliance_rad_n_m: float = quantity("rad/(N m) at the joint", at_least=0, default=0.0)

    def softening(self, teeth_n_m_rad: float) -> float:
        """Return how many times softer teeth and shaft in series are than the teeth alone."""
        return 1.0 + self.compliance_rad_n_m * teeth_n_m_rad
