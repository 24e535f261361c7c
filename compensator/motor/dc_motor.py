"""Motor current without a current sensor, and its friction part (paper, section 3.1).

    I = (Vs d - Ke w) / R                       (3)
    I_motor = I_load + I_friction               (5)

The paper's (7) and (8) do the same with duties: d_load = d - d_friction + Ke w / Vs, where `d_friction` is the duty
that a balanced joint needs at the same steady speed, back-EMF included: d_friction = (R I_friction + Ke w) / Vs.

Every function takes floats or arrays of one shape. `speed_rad_s` is that of the motor shaft.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from compensator.errors import ModelParameterError

Number = TypeVar("Number", float, NDArray[np.float64])


@dataclass(frozen=True, slots=True)
class MotorConstants:
    """What eq. (3) needs to know of a PM DC motor.

    Attributes:
        resistance_ohm: of winding and leads [ohm]; above 0.
        back_emf_v_s_rad: back-EMF constant at the shaft [V s/rad]; 0 or more.
    """

    resistance_ohm: float
    back_emf_v_s_rad: float

    def __post_init__(self) -> None:
        if not 0.0 < self.resistance_ohm < float("inf"):
            raise ModelParameterError(f"motor resistance is {self.resistance_ohm} ohm; allowed is above 0 ohm")
        if not 0.0 <= self.back_emf_v_s_rad < float("inf"):
            raise ModelParameterError(f"back-EMF constant is {self.back_emf_v_s_rad} V s/rad; allowed is 0 or more")


def at_temperature(
    motor: MotorConstants, measured_c: float, reference_c: float, copper_per_k: float, magnet_per_k: float = 0.0
) -> MotorConstants:
    """The constants of a warm motor: copper resists more, magnets pull less.

        R(T) = R (1 + a (T - T0)),  Ke(T) = Ke (1 - b (T - T0))

    Args:
        motor: the constants at the reference temperature.
        measured_c: T [degC].
        reference_c: T0 [degC].
        copper_per_k: a [1/K]; 0.00393 for copper.
        magnet_per_k: b [1/K]; 0.002 for ferrite, 0.0004 for samarium-cobalt.

    Raises:
        ModelParameterError: so far from the reference that the law leaves no resistance.
    """
    warmer_k = measured_c - reference_c
    return MotorConstants(
        resistance_ohm=motor.resistance_ohm * (1.0 + copper_per_k * warmer_k),
        back_emf_v_s_rad=motor.back_emf_v_s_rad * (1.0 - magnet_per_k * warmer_k),
    )


def current_a(motor: MotorConstants, duty: Number, speed_rad_s: Number, supply_v: float) -> Number:
    """Eq. (3): motor current [A] from PWM duty, motor speed and supply, in the steady state."""
    return (supply_v * duty - motor.back_emf_v_s_rad * speed_rad_s) / motor.resistance_ohm


def duty(motor: MotorConstants, current_a: Number, speed_rad_s: Number, supply_v: float) -> Number:
    """Eq. (3) inverted: the duty that gives a wanted current [A]; beyond -1 .. 1 the supply cannot give it."""
    return (motor.resistance_ohm * current_a + motor.back_emf_v_s_rad * speed_rad_s) / supply_v


def friction_duty(motor: MotorConstants, friction_current_a: Number, speed_rad_s: Number, supply_v: float) -> Number:
    """The duty of a balanced joint at a steady speed: friction and back-EMF, no load."""
    return duty(motor, friction_current_a, speed_rad_s, supply_v)
