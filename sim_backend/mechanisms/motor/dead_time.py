"""Dead time of the PWM stage: for a moment in each period both switches of a leg are off."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class DeadTime(Component):
    """Voltage lost to dead time, against the current, whatever its size (Jeong and Park 1991).

        u = voltage * duty - voltage * dead time * frequency * sgn(i);    i = 0 where the rest is too small

    A small duty drives no current at all. In current mode the drive's loop makes up for it.
    """

    time_s: float = quantity("s", at_least=0, default=0.0)
    frequency_hz: float = quantity("Hz", above=0, default=20e3)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.time_s * self.frequency_hz >= 0.5:
            half_s = 0.5 / self.frequency_hz
            self.refuse("time_s", f"must be less than half a PWM period, {half_s:g} s, or nothing is left of the duty")


@jitted
def lost_voltage(dead_time: DeadTime, supply_v: float) -> float:
    """Return the voltage that a current costs [V]."""
    return supply_v * dead_time.time_s * dead_time.frequency_hz
