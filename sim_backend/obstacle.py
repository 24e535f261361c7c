"""What the arm leans on: stiff contact with something that does not move."""

from dataclasses import dataclass
from typing import NamedTuple

from sim_backend.component import Component, quantity
from sim_backend.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Surface(Component):
    """A spring and a damper that push and never pull. p is the depth to which the arm is pressed in.

    T = k p + c dp/dt     where p > 0 and T > 0
    """

    present: bool = False
    stiffness_n_m_rad: float = quantity("N m/rad", above=0, default=5000.0)
    damping_n_m_s_rad: float = quantity("N m s/rad", at_least=0, default=5.0)


class Push(NamedTuple):
    """Torque on the arm over a step: known - slope * w, w the mean speed [rad/s].

    Attributes:
        known_n_m: torque at w = 0 [N m]; its sign is the direction in which the surface pushes.
        slope_n_m_s_rad: torque over speed.
        damping_n_m_s_rad: the part of the slope that loses energy.
    """

    known_n_m: float
    slope_n_m_s_rad: float
    damping_n_m_s_rad: float


@jitted
def push_of(surface: Surface, depth_rad: float, step_s: float) -> Push:
    """Return the push at a depth: positive into a surface above the arm, negative into one below, 0 without touch."""
    if depth_rad == 0.0:
        return Push(0.0, 0.0, 0.0)
    stiffness, damping = surface.stiffness_n_m_rad, surface.damping_n_m_s_rad
    return Push(-stiffness * depth_rad, 0.5 * step_s * stiffness + damping, damping)


@jitted
def both(one: Push, other: Push) -> Push:
    """Return two pushes as one."""
    return Push(
        one.known_n_m + other.known_n_m,
        one.slope_n_m_s_rad + other.slope_n_m_s_rad,
        one.damping_n_m_s_rad + other.damping_n_m_s_rad,
    )


@jitted
def push_torque(push: Push, mean_rad_s: float) -> float:
    """Return the torque on the arm at a mean speed [N m]; 0 where the surface would have to pull."""
    torque_n_m = push.known_n_m - push.slope_n_m_s_rad * mean_rad_s
    return torque_n_m if torque_n_m * push.known_n_m > 0.0 else 0.0


@jitted
def pressed_energy(surface: Surface, depth_rad: float) -> float:
    """Return the energy in the pressed surface [J]."""
    return 0.5 * surface.stiffness_n_m_rad * depth_rad * depth_rad
