"""A motor that changes as it warms: copper resists more, magnets pull less."""

from dataclasses import dataclass
from typing import NamedTuple

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class ThermalDrift(Component):
    """R(T) = R (1 + a (Tw - T0)) with the winding's, K(T) = K (1 - b (Th - T0)) with the housing's temperature.

    Copper: a = 0.0039 / K. Ferrite: b = 0.002 / K; samarium-cobalt: 0.0004 / K.
    """

    resistance_per_k: float = quantity("1/K", at_least=0, at_most=0.01, default=0.0)
    torque_constant_per_k: float = quantity("1/K", at_least=0, at_most=0.01, default=0.0)
    reference_c: float = quantity("degC", at_least=-273.15, at_most=1000, default=25.0)


class Winding(NamedTuple):
    """The motor as it is at its present temperature."""

    resistance_ohm: float
    torque_constant_n_m_a: float


@jitted
def drifted(
    drift: ThermalDrift, resistance_ohm: float, torque_constant_n_m_a: float, winding_c: float, housing_c: float
) -> Winding:
    """Return the winding at its temperatures. Far beyond what the laws are made for, it keeps a tenth."""
    resistance_scale = max(1.0 + drift.resistance_per_k * (winding_c - drift.reference_c), 0.1)
    torque_scale = max(1.0 - drift.torque_constant_per_k * (housing_c - drift.reference_c), 0.1)
    return Winding(resistance_ohm * resistance_scale, torque_constant_n_m_a * torque_scale)
