"""Dry and viscous friction of one side of the gear."""

from dataclasses import dataclass
from math import exp

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Friction(Component):
    """Coulomb, static, Stribeck and viscous friction (General Kinetic Friction, eqs (1), (2) of the paper).

        F(w) = (Fc + (Fs - Fc) exp(-|w / ws|^d)) (1 + g W),   Fs >= Fc > = 0
        at rest any torque up to F(0) is met by its equal: the joint holds exactly (set-valued friction)

    W is the weight hung on the axis, g the growth with it. Values at the shaft where the friction acts: the motor
    shaft for the drive side, the joint for the arm side.
    """

    coulomb_n_m: float = quantity("N m", at_least=0, default=0.0)
    static_n_m: float = quantity("N m", at_least=0, default=0.0)
    stribeck_rad_s: float = quantity("rad/s", above=0, default=1.0)
    stribeck_exponent: float = quantity("1", above=0, default=2.0)
    viscous_n_m_s_rad: float = quantity("N m s/rad", at_least=0, default=0.0)
    growth_per_n: float = quantity("1/N", at_least=0, default=0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.static_n_m < self.coulomb_n_m:
            self.refuse("static_n_m", f"static friction is never below Coulomb friction, {self.coulomb_n_m:g} N m")


@jitted
def dry_friction(
    friction: Friction, speed_rad_s: float, weight_n: float, static_factor: float, coulomb_factor: float
) -> float:
    """Return the dry friction torque at a speed [N m]; at speed 0 the torque that the joint can hold.

    Args:
        friction: the side's `Friction`.
        speed_rad_s: speed of the side's shaft.
        weight_n: weight hung on the axis.
        static_factor: this stop's static friction over the nominal one (it differs from stop to stop).
        coulomb_factor: Coulomb friction here over the nominal one (it wanders along the path).
    """
    coulomb_n_m = friction.coulomb_n_m * coulomb_factor
    rise_n_m = max(friction.static_n_m * static_factor - coulomb_n_m, 0.0)
    if speed_rad_s != 0.0 and rise_n_m > 0.0:
        relative = speed_rad_s / friction.stribeck_rad_s
        # the usual exponent without the cost of a power
        exponent = friction.stribeck_exponent
        power = relative * relative if exponent == 2.0 else abs(relative) ** exponent
        rise_n_m *= exp(-power) if power < 40.0 else 0.0
    return (coulomb_n_m + rise_n_m) * (1.0 + friction.growth_per_n * weight_n)
