"""Cogging: the magnets' pull towards the slots of the motor's iron."""

from dataclasses import dataclass
from math import cos, sin

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Cogging(Component):
    """Torque at the motor shaft T = a sin(n q - p), q the motor angle. It takes no energy over a turn.

    n is the least common multiple of poles and slots.
    """

    amplitude_n_m: float = quantity("N m", at_least=0, default=0.0)
    cycles_per_turn: float = quantity("1", above=0, default=12.0)
    phase_rad: float = quantity("rad", default=0.0)


@jitted
def cogging_torque(cogging: Cogging, motor_rad: float) -> float:
    """Return the torque on the motor shaft [N m]."""
    if cogging.amplitude_n_m == 0.0:
        return 0.0
    return cogging.amplitude_n_m * sin(cogging.cycles_per_turn * motor_rad - cogging.phase_rad)


@jitted
def cogging_energy(cogging: Cogging, motor_rad: float) -> float:
    """Return the energy in the magnets' field [J]; 0 where the rotor likes to rest."""
    swing = 1.0 + cos(cogging.cycles_per_turn * motor_rad - cogging.phase_rad)
    return cogging.amplitude_n_m / cogging.cycles_per_turn * swing
