"""Grease that thins as it warms."""

from dataclasses import dataclass
from math import exp

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Lubricant(Component):
    """Viscosity after Vogel, Fulcher and Tammann (Vogel 1921), relative to the reference temperature.

        B(T) / B(Tref) = exp(b / (T - T0) - b / (Tref - T0))

    b about 1000 K and T0 about -100 degC make a mineral oil: near 20 degC it loses 7 % per kelvin. b = 0 is off.
    """

    vogel_k: float = quantity("K", at_least=0, at_most=5000, default=0.0)
    divergence_c: float = quantity("degC", at_least=-273.15, default=-100.0)
    reference_c: float = quantity("degC", at_least=-273.15, at_most=1000, default=25.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.reference_c <= self.divergence_c:
            self.refuse("reference_c", f"must be above the divergence temperature, {self.divergence_c:g} degC")


@jitted
def viscosity_scale(lubricant: Lubricant, temperature_c: float) -> float:
    """Return viscous friction at a temperature over that at the reference temperature."""
    if lubricant.vogel_k == 0.0:
        return 1.0
    # colder than the law is made for: the grease is stiff, not infinitely so
    above_k = max(temperature_c - lubricant.divergence_c, 10.0)
    return exp(lubricant.vogel_k / above_k - lubricant.vogel_k / (lubricant.reference_c - lubricant.divergence_c))
