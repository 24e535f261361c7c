"""What the arm leans on: stiff contact with something that does not move."""

from dataclasses import dataclass
from typing import NamedTuple

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.crossing import closing_line, opening_line
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Surface(Component):
    """A spring and a damper that push and never pull. p is the depth to which the arm is pressed in.

    T = k p + c dp/dt     where p > 0 and T > 0
    """

    present: bool = False
    stiffness_n_m_rad: float = quantity("N m/rad", above=0, default=5000.0)
    damping_n_m_s_rad: float = quantity("N m s/rad", at_least=0, default=5.0)


APART, TOUCHING, CROSSING, RELEASED = range(4)


class Push(NamedTuple):
    """Torque on the arm over a step: known - slope * w, w the mean speed [rad/s].

    Attributes:
        phase: how arm and surface meet: not at all, all through the step, for a part of it; or the arm was let go
            because the surface would have to pull.
        side: +1 where the surface lies above the arm, -1 below, 0 where nothing touches.
        known_n_m: torque at w = 0 [N m].
        slope_n_m_s_rad: loss of torque with w.
        damping_n_m_s_rad: what loses energy, mean over the step.
    """

    phase: int
    side: float
    known_n_m: float
    slope_n_m_s_rad: float
    damping_n_m_s_rad: float


@jitted
def no_push(phase: int) -> Push:
    """Return the push of nothing."""
    return Push(phase, 0.0, 0.0, 0.0, 0.0)


@jitted
def push_of(surface: Surface, depth_rad: float, step_s: float) -> Push:
    """Return the push at a depth: positive into a surface above the arm, negative into one below, 0 without touch."""
    if depth_rad == 0.0:
        return no_push(APART)
    stiffness, damping = surface.stiffness_n_m_rad, surface.damping_n_m_s_rad
    side = 1.0 if depth_rad > 0.0 else -1.0
    return Push(TOUCHING, side, -stiffness * depth_rad, 0.5 * step_s * stiffness + damping, damping)


@jitted
def crossing_push(surface: Surface, start_rad: float, end_rad: float, way_rad: float, step_s: float) -> Push:
    """Return the push of a surface between two depths, where the arm meets or leaves one: see `crossing`.

    Args:
        surface: what is met or left, or not.
        start_rad: depth at the start of the step; 0 where it does not touch.
        end_rad: depth at the end, as last tried.
        way_rad: of the arm over the step, as last tried.
        step_s: length of the step.
    """
    if start_rad != 0.0 and end_rad != 0.0:
        return push_of(surface, start_rad, step_s)
    if start_rad == 0.0 and end_rad == 0.0:
        return no_push(APART)
    stiffness, damping = surface.stiffness_n_m_rad, surface.damping_n_m_s_rad
    if start_rad == 0.0:
        line = closing_line(stiffness, damping, end_rad, way_rad, step_s)
    else:
        line = opening_line(stiffness, damping, start_rad, way_rad, step_s)
    side = 1.0 if start_rad + end_rad > 0.0 else -1.0
    return Push(CROSSING, side, -line.known_n_m, step_s * line.slope_n_m_rad, line.share * damping)


@jitted
def both(one: Push, other: Push) -> Push:
    """Return two pushes as one."""
    return Push(
        max(one.phase, other.phase),
        one.side if one.side != 0.0 else other.side,
        one.known_n_m + other.known_n_m,
        one.slope_n_m_s_rad + other.slope_n_m_s_rad,
        one.damping_n_m_s_rad + other.damping_n_m_s_rad,
    )


@jitted
def push_torque(push: Push, mean_rad_s: float) -> float:
    """Return the torque on the arm at a mean speed [N m]; 0 where the surface would have to pull."""
    torque_n_m = push.known_n_m - push.slope_n_m_s_rad * mean_rad_s
    return torque_n_m if torque_n_m * push.side < 0.0 else 0.0


@jitted
def pressed_energy(surface: Surface, depth_rad: float) -> float:
    """Return the energy in the pressed surface [J]."""
    return 0.5 * surface.stiffness_n_m_rad * depth_rad * depth_rad
