"""A stiff contact that closes or opens in the middle of a step, without a gain or loss of energy.

Pressed by p, a contact keeps the energy U = k p^2 / 2. Over a step in which it closes (apart at first, pressed by p at
last) or opens (pressed by p at first), the mean torque that does exactly that work over the way d is the discrete
gradient (Gonzalez 1996)

    T = (U(end) - U(start)) / d + damping = +-k p^2 / (2 d) +- c p / h

(damping acts for the share |p / d| of the step). Without this, a contact would be found pressed at the start of the
next step, with an energy that nobody put in: (step times contact frequency)^2 / 3 of the impact's, on average.
"""

from typing import NamedTuple

from sim_backend.plant.jit import jitted

MOST_TRIES = 12  # Newton's method on a convex law, from its steep side: four or five do
_CLOSE_ENOUGH = 1e-9  # of the way


class Crossing(NamedTuple):
    """The torque of a contact that closes or opens, against the way d, as a line: known + slope d.

    Attributes:
        known_n_m: torque at d = 0 by the line.
        slope_n_m_rad: growth with d.
        share: part of the step for which the contact is closed.
    """

    known_n_m: float
    slope_n_m_rad: float
    share: float


@jitted
def closing_line(
    stiffness_n_m_rad: float, damping_n_m_s_rad: float, pressed_rad: float, way_rad: float, step_s: float
) -> Crossing:
    """Return the tangent to the law of a contact that closes.

    Args:
        stiffness_n_m_rad: k.
        damping_n_m_s_rad: c.
        pressed_rad: p at the end of the step, signed as the way.
        way_rad: d over the step, not 0.
        step_s: h.
    """
    share = min(max(pressed_rad / way_rad, 0.0), 1.0)
    torque_n_m = 0.5 * stiffness_n_m_rad * share * pressed_rad + damping_n_m_s_rad * pressed_rad / step_s
    slope = stiffness_n_m_rad * share * (1.0 - 0.5 * share) + damping_n_m_s_rad / step_s
    return Crossing(torque_n_m - slope * way_rad, slope, share)


@jitted
def opening_line(
    stiffness_n_m_rad: float, damping_n_m_s_rad: float, pressed_rad: float, way_rad: float, step_s: float
) -> Crossing:
    """Return the tangent to the law of a contact that opens.

    Args:
        stiffness_n_m_rad: k.
        damping_n_m_s_rad: c.
        pressed_rad: p at the start of the step, not 0.
        way_rad: d over the step; one that stays pressed is taken to open just so.
        step_s: h.
    """
    share = -pressed_rad / way_rad if abs(way_rad) > abs(pressed_rad) and way_rad * pressed_rad < 0.0 else 1.0
    torque_n_m = 0.5 * stiffness_n_m_rad * share * pressed_rad - damping_n_m_s_rad * pressed_rad / step_s
    slope = 0.5 * stiffness_n_m_rad * share * share
    return Crossing(torque_n_m + slope * pressed_rad / share, slope, share)


@jitted
def one_after_the_other(opening: Crossing, closing: Crossing) -> Crossing:
    """Return the torque where one contact opens and another closes within the step."""
    return Crossing(
        opening.known_n_m + closing.known_n_m,
        opening.slope_n_m_rad + closing.slope_n_m_rad,
        opening.share + closing.share,
    )


@jitted
def is_close(way_rad: float, before_rad: float) -> bool:
    """Tell whether one more try is not worth it."""
    return abs(way_rad - before_rad) <= _CLOSE_ENOUGH * abs(way_rad)
