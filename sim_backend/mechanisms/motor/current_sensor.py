"""The drive's measurement of the motor current."""

from dataclasses import dataclass
from math import floor, nan

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted
from sim_backend.plant.randomness import sensor_noise
from sim_backend.plant.state import State


@dataclass(frozen=True, kw_only=True)
class CurrentSensor(Component):
    """Motor current as measured: gain * current + offset + white noise, in whole steps of the resolution.

    Absent, the current is NaN. Resolution 0 is a converter finer than matters.
    """

    present: bool = False
    gain: float = quantity("1", above=0, default=1.0)
    offset_a: float = quantity("A", default=0.0)
    noise_a: float = quantity("A, standard deviation", at_least=0, default=0.0)
    resolution_a: float = quantity("A", at_least=0, default=0.0)


@jitted
def measured_current(state: State, sensor: CurrentSensor, current_a: float) -> float:
    """Return the current as the drive measures it [A]; NaN without a sensor."""
    if not sensor.present:
        return nan
    noise_a = sensor.noise_a * sensor_noise(state) if sensor.noise_a > 0.0 else 0.0
    measured_a: float = sensor.gain * current_a + sensor.offset_a + noise_a
    if sensor.resolution_a == 0.0:
        return measured_a
    return sensor.resolution_a * floor(measured_a / sensor.resolution_a + 0.5)
