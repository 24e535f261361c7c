"""Friction that gives a little before it slips: the asperities of the contact as elastic bristles."""

from dataclasses import dataclass
from math import cos, exp, pi
from typing import NamedTuple

from sim_backend.mechanisms.friction.friction import Friction
from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted

# largest of w exp(-(w / ws)^2) over ws: 1 / sqrt(2 e)
_WORST_SPEED = 0.42888194248035344


@dataclass(frozen=True, kw_only=True)
class Bristle(Component):
    """Dynamic friction: LuGre (Canudas de Wit et al. 1995), elasto-plastic (Dupont et al. 2002).

        dz/dt = w - a(z, w) |w| s0 z / g(w),    T = s0 z + s1 exp(-(w / ws)^2) dz/dt

    g is the dry friction of the side in the direction of motion, with all that changes it, and ws its Stribeck speed.
    The micro-damping s1 fades as the contact slides (Olsson 1996). a = 1 everywhere is LuGre, whose bristles creep
    under any torque. With an elastic fraction b, a is 0 up to the deflection b g / s0 and then rises smoothly to 1:
    below that the contact is a spring and does not creep at all. Stiffness 0 is off: the joint then sticks rigidly.
    Values at the shaft where the friction acts.
    """

    stiffness_n_m_rad: float = quantity("N m/rad", at_least=0, default=0.0)
    damping_n_m_s_rad: float = quantity("N m s/rad", at_least=0, default=0.0)
    elastic_fraction: float = quantity("1", at_least=0, at_most=0.95, default=0.0)

    def check(self, friction: Friction) -> None:
        """Refuse bristles that would make energy (passivity: s1(w) |w| <= 4 g(w) at every speed).

        Raises:
            ParameterError: the micro-damping is too strong for the friction.
        """
        most = 4.0 * friction.coulomb_n_m / (_WORST_SPEED * friction.stribeck_rad_s)
        if self.stiffness_n_m_rad > 0.0 and self.damping_n_m_s_rad > most:
            self.refuse(
                "damping_n_m_s_rad",
                f"bristles would make energy: s1(w) |w| <= 4 g(w) allows at most {most:.3g} N m s/rad with "
                f"Friction.coulomb_n_m = {friction.coulomb_n_m:g} N m, stribeck_rad_s = {friction.stribeck_rad_s:g}",
            )


class BristleLine(NamedTuple):
    """What bristles do over a step, at the joint; w is the mean speed of the side over the step [rad/s].

    Attributes:
        known_n_m: torque against motion at w = 0.
        slope_n_m_s_rad: growth of that torque with w.
        kept_rad: deflection at the end of the step at w = 0, at the shaft.
        gain_s: growth of that deflection with w, shaft over joint.
    """

    known_n_m: float
    slope_n_m_s_rad: float
    kept_rad: float
    gain_s: float


@jitted
def bristle_line(
    bristle: Bristle, friction: Friction, ratio: float, deflection_rad: float, speed_rad_s: float, limit_n_m: float,
    step_s: float,
) -> BristleLine:  # fmt: skip
    """Return torque and deflection over a step as lines in the step's mean speed.

    Exponential in the deflection: exact at constant speed, however fast it saturates within the step; implicit in the
    speed, so that stiff bristles cannot blow up. Second order where the speed is guessed to second order.

    Args:
        bristle: the side's bristles.
        friction: the side's friction.
        ratio: shaft turns per joint turn.
        deflection_rad: of the bristles at the start of the step, at the shaft.
        speed_rad_s: a guess of the step's mean speed, at the shaft.
        limit_n_m: dry friction in that direction at that speed, at the shaft.
        step_s: length of the step.
    """
    stiffness = bristle.stiffness_n_m_rad
    if stiffness == 0.0:
        return BristleLine(0.0, 0.0, 0.0, 0.0)
    per_limit = stiffness / max(limit_n_m, 1e-12)
    rate = abs(speed_rad_s) * per_limit
    if bristle.elastic_fraction > 0.0:
        # how far the bristles give way, at the middle of the step
        way = 1.0 if speed_rad_s > 0.0 else -1.0
        bent = way * deflection_rad * per_limit
        bent += 0.5 * step_s * rate * (1.0 - plastic_share(bristle.elastic_fraction, bent) * bent)
        rate *= plastic_share(bristle.elastic_fraction, bent)
    damping = _fading(bristle.damping_n_m_s_rad, speed_rad_s / friction.stribeck_rad_s)
    lost, first, second = _decay(rate * step_s)
    known_n_m = (stiffness - damping * rate) * first * deflection_rad
    slope = stiffness * step_s * second + damping * first
    return BristleLine(ratio * known_n_m, ratio * ratio * slope, (1.0 - lost) * deflection_rad, ratio * step_s * first)


@jitted
def plastic_share(elastic_fraction: float, bent: float) -> float:
    """Return a: 0 while the bristles only bend, 1 where they slip (Dupont et al. 2002, eq. (12)).

    Args:
        elastic_fraction: b of `Bristle`.
        bent: deflection in the direction of motion over the deflection of steady slip.
    """
    if bent <= elastic_fraction:
        return 0.0
    if bent >= 1.0:
        return 1.0
    return 0.5 - 0.5 * cos(pi * (bent - elastic_fraction) / (1.0 - elastic_fraction))


@jitted
def bend(
    bristle: Bristle, line: BristleLine, deflection_rad: float, mean_rad_s: float, step_s: float
) -> tuple[float, float]:
    """Return (deflection after a step [rad], what the bristles took for good [J]), at a mean speed of the joint."""
    after_rad = line.kept_rad + line.gain_s * mean_rad_s
    work_j = step_s * mean_rad_s * (line.known_n_m + line.slope_n_m_s_rad * mean_rad_s)
    return after_rad, work_j + bristle_energy(bristle, deflection_rad) - bristle_energy(bristle, after_rad)


@jitted
def bristle_energy(bristle: Bristle, deflection_rad: float) -> float:
    """Return the energy in the bent bristles [J]."""
    return 0.5 * bristle.stiffness_n_m_rad * deflection_rad * deflection_rad


@jitted
def is_slipping(bristle: Bristle, deflection_rad: float, speed_rad_s: float, limit_n_m: float) -> bool:
    """Tell whether the bristles are bent as far as they go, in the direction of motion."""
    if deflection_rad * speed_rad_s <= 0.0:
        return False
    return bristle.stiffness_n_m_rad * abs(deflection_rad) >= 0.9 * limit_n_m


@jitted
def _fading(damping: float, relative: float) -> float:
    """Return the micro-damping at a speed over the Stribeck speed; 0 where nothing of it is left."""
    power = relative * relative
    return damping * exp(-power) if power < 40.0 else 0.0


@jitted
def _decay(x: float) -> tuple[float, float, float]:
    """Return 1 - exp(-x), and its first and second mean over 0 .. x (the phi functions of exponential integrators)."""
    if x < 1e-3:
        first = 1.0 - x * (0.5 - x / 6.0)
        return x * first, first, 0.5 - x * (1.0 / 6.0 - x / 24.0)
    lost = 1.0 - exp(-x)
    per_x = 1.0 / x
    first = lost * per_x
    return lost, first, (1.0 - first) * per_x
