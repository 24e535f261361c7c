"""An encoder disc that does not sit in the middle of its shaft."""

from dataclasses import dataclass
from math import sin

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Eccentricity(Component):
    """The encoder sees q + a sin(q - p), q the motor angle; a = offset of the disc / radius of its track."""

    amplitude_rad: float = quantity("rad of the motor", at_least=0, at_most=0.5, default=0.0)
    phase_rad: float = quantity("rad", default=0.0)


@jitted
def seen_angle(eccentricity: Eccentricity, motor_rad: float) -> float:
    """Return the motor angle that the encoder sees [rad]."""
    if eccentricity.amplitude_rad == 0.0:
        return motor_rad
    return motor_rad + eccentricity.amplitude_rad * sin(motor_rad - eccentricity.phase_rad)
