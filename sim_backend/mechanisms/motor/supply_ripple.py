"""A supply that is not steady: another axis on the same bus, a charger that hunts, a rectifier's ripple."""

from dataclasses import dataclass
from math import pi, sin

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class SupplyRipple(Component):
    """The voltage at the stage is V0 (1 + a sin(2 pi f t)), t the time since the plant was made.

    What the drive says of its supply is averaged over seconds and does not show it. In current mode the drive's loop
    makes up for it.
    """

    fraction: float = quantity("1", at_least=0, at_most=0.5, default=0.0)
    frequency_hz: float = quantity("Hz", above=0, at_most=1000, default=2.0)


@jitted
def ripple_scale(ripple: SupplyRipple, turns: float) -> float:
    """Return the voltage over its mean, so many periods after the start."""
    if ripple.fraction == 0.0:
        return 1.0
    return 1.0 + ripple.fraction * sin(2.0 * pi * turns)


@jitted
def turned(ripple: SupplyRipple, turns: float, step_s: float) -> float:
    """Return the periods that have passed after one more step; whole ones are forgotten."""
    if ripple.fraction == 0.0:
        return 0.0
    return (turns + ripple.frequency_hz * step_s) % 1.0
