"""A hose or cable bundle that is dragged along with the joint, and remembers where it has been."""

from dataclasses import dataclass
from typing import NamedTuple

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Hose(Component):
    """Hysteresis of position, whatever the speed: strands that bend until they slide in their sheath.

        T = -sum_j (k / 3) e_j,    de_j = dq while |e_j| < r_j, else 0;    r_j = j / 3 of the reach, j = 1, 2, 3

    Three elastic sliders in parallel (Prandtl 1928, Ishlinskii 1944): a turn back from any angle starts a loop of its
    own, which closes where the motion passes that angle again. The torque never exceeds 2/3 k times the reach. A reach
    of some tenths of a radian sets it apart from bristles, which slip after a hundredth of that. Stiffness 0 is off.
    """

    stiffness_n_m_rad: float = quantity("N m/rad", at_least=0, default=0.0)
    reach_rad: float = quantity("rad", above=0, default=0.5)


class Bend(NamedTuple):
    """How far each strand is bent [rad], the one that slides first in front."""

    first_rad: float
    second_rad: float
    third_rad: float


@jitted
def bent(hose: Hose, before: Bend, turn_rad: float) -> Bend:
    """Return the strands after the joint has turned one way by an angle [rad]."""
    if hose.stiffness_n_m_rad == 0.0:
        return before
    return Bend(
        _slide(before.first_rad + turn_rad, hose.reach_rad / 3.0),
        _slide(before.second_rad + turn_rad, hose.reach_rad * 2.0 / 3.0),
        _slide(before.third_rad + turn_rad, hose.reach_rad),
    )


@jitted
def hose_torque(hose: Hose, bend: Bend) -> float:
    """Return the torque of the hose on the arm [N m]."""
    if hose.stiffness_n_m_rad == 0.0:
        return 0.0
    return -hose.stiffness_n_m_rad / 3.0 * (bend.first_rad + bend.second_rad + bend.third_rad)


@jitted
def hose_energy(hose: Hose, bend: Bend) -> float:
    """Return the energy in the bent strands [J]."""
    squares = bend.first_rad**2 + bend.second_rad**2 + bend.third_rad**2
    return hose.stiffness_n_m_rad / 6.0 * squares


@jitted
def _slide(bend_rad: float, reach_rad: float) -> float:
    return min(max(bend_rad, -reach_rad), reach_rad)
