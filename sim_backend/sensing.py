"""What the drive measures: position and speed by a motor-side encoder, current, and how late all that is."""

from dataclasses import dataclass
from math import floor, nan, pi

from sim_backend.component import Component, quantity
from sim_backend.jit import jitted
from sim_backend.randomness import sensor_noise
from sim_backend.state import State


@dataclass(frozen=True, kw_only=True)
class Encoder(Component):
    """Encoder or resolver on the motor shaft: whole counts; the speed is counts gained in a window / the window."""

    counts_per_turn: float = quantity("counts per motor turn", at_least=1)
    speed_window_s: float = quantity("s", above=0, default=5e-3)


@dataclass(frozen=True, kw_only=True)
class CurrentSensor(Component):
    """Motor current as measured: gain * current + offset + white noise. Absent, the current is NaN."""

    present: bool = False
    gain: float = quantity("1", above=0, default=1.0)
    offset_a: float = quantity("A", default=0.0)
    noise_a: float = quantity("A, standard deviation", at_least=0, default=0.0)


@dataclass(frozen=True, kw_only=True)
class Latency(Component):
    """Delay of everything measured. The drive does not know of it, so the age in its samples does not tell."""

    delay_s: float = quantity("s", at_least=0, at_most=0.1, default=0.0)


@jitted
def counts(encoder: Encoder, ratio: float, rotor_rad: float) -> float:
    """Return the whole counts at a rotor angle, given at the joint [rad]."""
    return floor(rotor_rad * ratio * encoder.counts_per_turn / (2.0 * pi))


@jitted
def radians_per_count(encoder: Encoder, ratio: float) -> float:
    """Return the joint angle of one count [rad]."""
    return 2.0 * pi / (encoder.counts_per_turn * ratio)


@jitted
def measured_current(state: State, sensor: CurrentSensor, current_a: float) -> float:
    """Return the current as the drive measures it [A]; NaN without a sensor."""
    if not sensor.present:
        return nan
    noise_a = sensor.noise_a * sensor_noise(state) if sensor.noise_a > 0.0 else 0.0
    return sensor.gain * current_a + sensor.offset_a + noise_a
