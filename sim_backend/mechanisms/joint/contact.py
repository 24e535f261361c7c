"""The gear: ratio, free play, and the stiffness of the teeth once they touch."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Gear(Component):
    """Gear with free play, seen from the joint. d = motor angle / ratio - joint angle.

        |d| <= backlash / 2:   no torque
        beyond, by p:          T = k p + c dp/dt, and never a pull

    The teeth touch on one flank at a time; between the flanks rotor and arm move freely of each other.
    Without backlash the gear is a spring and a damper, both ways.
    """

    ratio: float = quantity("motor turns per joint turn", above=0)
    backlash_rad: float = quantity("rad at the joint, total", at_least=0, default=0.0)
    stiffness_n_m_rad: float = quantity("N m/rad at the joint", above=0)
    damping_n_m_s_rad: float = quantity("N m s/rad at the joint", at_least=0, default=0.0)


@jitted
def flank(gear: Gear, twist_rad: float) -> float:
    """Return which flank touches at a twist: +1, -1, or 0 inside the free play."""
    if gear.backlash_rad == 0.0 or twist_rad > 0.5 * gear.backlash_rad:
        return 1.0
    if twist_rad < -0.5 * gear.backlash_rad:
        return -1.0
    return 0.0


@jitted
def penetration(gear: Gear, side: float, twist_rad: float) -> float:
    """Return how far the teeth are pressed into each other [rad], signed as the twist."""
    return twist_rad - side * 0.5 * gear.backlash_rad


@jitted
def is_pull(gear: Gear, side: float, torque_n_m: float) -> bool:
    """Tell whether a flank would have to pull, which teeth cannot."""
    return gear.backlash_rad > 0.0 and torque_n_m * side < 0.0


@jitted
def contact_energy(gear: Gear, stiffness_n_m_rad: float, twist_rad: float) -> float:
    """Return the energy in the pressed teeth, and in what winds up behind them [J]."""
    side = flank(gear, twist_rad)
    if side == 0.0:
        return 0.0
    return 0.5 * stiffness_n_m_rad * penetration(gear, side, twist_rad) ** 2
