"""What the drive measures of motion, by a motor-side encoder, and how late that is."""

from dataclasses import dataclass
from math import floor, pi

from sim_backend.mechanisms.joint.eccentricity import Eccentricity, seen_angle
from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Encoder(Component):
    """Encoder or resolver on the motor shaft: whole counts; the speed is counts gained in a window / the window."""

    counts_per_turn: float = quantity("counts per motor turn", at_least=1)
    speed_window_s: float = quantity("s", above=0, at_most=1, default=5e-3)


@dataclass(frozen=True, kw_only=True)
class Latency(Component):
    """Delay of everything measured. The drive does not know of it, so the age in its samples does not tell."""

    delay_s: float = quantity("s", at_least=0, at_most=0.1, default=0.0)


@jitted
def counts(encoder: Encoder, eccentricity: Eccentricity, ratio: float, rotor_rad: float) -> float:
    """Return the whole counts at a rotor angle, given at the joint [rad]."""
    return floor(seen_angle(eccentricity, rotor_rad * ratio) * encoder.counts_per_turn / (2.0 * pi))


@jitted
def radians_per_count(encoder: Encoder, ratio: float) -> float:
    """Return the joint angle of one count [rad]."""
    return 2.0 * pi / (encoder.counts_per_turn * ratio)
