"""The operator's hand and arm at the tip of a master joint."""

from dataclasses import dataclass
from math import cos, pi, sin
from typing import NamedTuple

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted

FOR_GOOD_S = 1e12


@dataclass(frozen=True, kw_only=True)
class Operator(Component):
    """A hand that holds the arm at a lever and wants to move it. Its impedance is that of hand and forearm.

        F = K (x* - x) + B (dx*/dt - dx/dt), |F| <= strength;    interaction: F - M d2x/dt2,    x = lever q

    Linear mass, damper and spring round the intended motion x* (Hogan 1985; the human arm, relaxed to stiff: 1 to 3 kg,
    5 to 40 N s/m, 50 to 1000 N/m). The hand meets the arm at the arm's speed when it takes hold, and its weight is its
    owner's to carry. The intended motion is a sum: an angle held, a reach of least jerk to a further angle (Flash and
    Hogan 1985), and a sinusoid from the moment of grip on:

        q* = hold + reach (10 s^3 - 15 s^4 + 6 s^5) + amplitude sin(2 pi f (t - grip)),    s = (t - start) / duration
    """

    present: bool = False
    lever_m: float = quantity("m, axis to hand", above=0, default=0.5)
    mass_kg: float = quantity("kg", at_least=0, default=1.0)
    damping_n_s_m: float = quantity("N s/m", at_least=0, default=10.0)
    stiffness_n_m: float = quantity("N/m", at_least=0, default=200.0)
    strength_n: float = quantity("N", above=0, default=100.0)
    grip_s: float = quantity("s, the plant's time", at_least=0, default=0.0)
    release_s: float = quantity("s, the plant's time", above=0, default=FOR_GOOD_S)
    hold_rad: float = quantity("rad", default=0.0)
    reach_rad: float = quantity("rad", default=0.0)
    reach_start_s: float = quantity("s, the plant's time", at_least=0, default=0.0)
    reach_duration_s: float = quantity("s", above=0, default=1.0)
    amplitude_rad: float = quantity("rad", at_least=0, default=0.0)
    frequency_hz: float = quantity("Hz", above=0, at_most=100, default=0.5)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.release_s <= self.grip_s:
            self.refuse("release_s", f"a hand lets go after it has taken hold, at {self.grip_s:g} s")


class Hold(NamedTuple):
    """What the hand does over a step, at the joint; w is the mean speed [rad/s].

    Attributes:
        inertia_kg_m2: of the hand, which goes along.
        known_n_m: torque of the hand's spring and damper at w = 0.
        slope_n_m_s_rad: loss of that torque with w.
    """

    inertia_kg_m2: float
    known_n_m: float
    slope_n_m_s_rad: float


@jitted
def intended(operator: Operator, time_s: float) -> tuple[float, float]:
    """Return the angle [rad] and speed [rad/s] that the operator has in mind."""
    s = min(max((time_s - operator.reach_start_s) / operator.reach_duration_s, 0.0), 1.0)
    turn = 2.0 * pi * operator.frequency_hz
    phase = turn * (time_s - operator.grip_s)
    angle_rad = operator.hold_rad + operator.reach_rad * s * s * s * (10.0 - s * (15.0 - 6.0 * s))
    speed_rad_s = operator.reach_rad * 30.0 * s * s * (1.0 - s) * (1.0 - s) / operator.reach_duration_s
    angle_rad += operator.amplitude_rad * sin(phase)
    speed_rad_s += operator.amplitude_rad * turn * cos(phase)
    return angle_rad, speed_rad_s


@jitted
def hold_of(operator: Operator, time_s: float, angle_rad: float, speed_rad_s: float, step_s: float) -> Hold:
    """Return what the hand does over the coming step.

    Args:
        operator: of the plant.
        time_s: at the start of the step.
        angle_rad: of the arm, at the start of the step.
        speed_rad_s: a guess of the arm's mean speed over the step.
        step_s: length of the step.
    """
    if not operator.present or not operator.grip_s <= time_s < operator.release_s:
        return Hold(0.0, 0.0, 0.0)
    lever2_m2 = operator.lever_m * operator.lever_m
    wanted_rad, wanted_rad_s = intended(operator, time_s + 0.5 * step_s)
    damping = lever2_m2 * operator.damping_n_s_m
    known_n_m = lever2_m2 * operator.stiffness_n_m * (wanted_rad - angle_rad) + damping * wanted_rad_s
    slope = damping + 0.5 * step_s * lever2_m2 * operator.stiffness_n_m
    strength_n_m = operator.strength_n * operator.lever_m
    if abs(known_n_m - slope * speed_rad_s) > strength_n_m:
        known_n_m, slope = (strength_n_m if known_n_m > slope * speed_rad_s else -strength_n_m), 0.0
    return Hold(lever2_m2 * operator.mass_kg, known_n_m, slope)


@jitted
def hand_torque(hold: Hold, before_rad_s: float, after_rad_s: float, step_s: float) -> float:
    """Return the torque of the hand on the arm [N m], mean over a step between two speeds."""
    mean_rad_s = 0.5 * (before_rad_s + after_rad_s)
    inertial_n_m = hold.inertia_kg_m2 * (after_rad_s - before_rad_s) / step_s
    return hold.known_n_m - hold.slope_n_m_s_rad * mean_rad_s - inertial_n_m
