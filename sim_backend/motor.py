"""Permanent-magnet DC motor on a PWM stage."""

from dataclasses import dataclass

from sim_backend.component import Component, quantity
from sim_backend.jit import jitted

OPEN = 0  # power stage off: the terminals are open, no current flows
VOLTAGE = 1  # the demand is the PWM duty
CURRENT = 2  # the demand is the motor current, which the drive's own loop sets
BRAKE = 3  # the terminals are shorted


@dataclass(frozen=True, kw_only=True)
class Motor(Component):
    """PM DC motor, values at the motor shaft.

        L di/dt = u - R i - K w,    torque = K i

    In SI the torque constant and the back-EMF constant are one number, or energy would come from nowhere.
    With L = 0 the current follows at once: i = (u - K w) / R, eq. (3) of the paper.
    """

    resistance_ohm: float = quantity("ohm", above=0)
    torque_constant_n_m_a: float = quantity("N m/A = V s/rad", above=0)
    rotor_inertia_kg_m2: float = quantity("kg m2", above=0)
    inductance_h: float = quantity("H", at_least=0, default=0.0)


@dataclass(frozen=True, kw_only=True)
class Supply(Component):
    """Supply and PWM stage: u = voltage * duty, the duty in whole counts of full scale."""

    voltage_v: float = quantity("V", above=0)
    duty_counts: float = quantity("counts of full scale", at_least=1, default=1000.0)


@dataclass(frozen=True, kw_only=True)
class CurrentLoop(Component):
    """The drive's own current control, for drives that have it: a first-order lag, limited by the supply."""

    present: bool = False
    time_constant_s: float = quantity("s", above=0, default=5e-4)


@jitted
def current_line(
    stage: int,
    demand: float,
    current_a: float,
    speed_rad_s: float,
    motor: Motor,
    supply: Supply,
    loop: CurrentLoop,
    step_s: float,
) -> tuple[float, float]:
    """Return (i0, g): over the coming step the current is i0 - g * w, w the motor's mean speed [rad/s].

    Affine in the speed, so that the back-EMF damps the rotor implicitly, however small R is. Backward Euler in L.
    """
    if stage == OPEN:
        return 0.0, 0.0
    inertia_ohm = motor.inductance_h / step_s
    if stage == CURRENT:
        tracked_a = current_a + (demand - current_a) * step_s / (step_s + loop.time_constant_s)
        needed_v = (
            motor.resistance_ohm * tracked_a
            + motor.torque_constant_n_m_a * speed_rad_s
            + inertia_ohm * (tracked_a - current_a)
        )
        if abs(needed_v) <= supply.voltage_v:
            return tracked_a, 0.0
        voltage_v = supply.voltage_v if needed_v > 0.0 else -supply.voltage_v
    elif stage == VOLTAGE:
        voltage_v = demand * supply.voltage_v
    else:
        voltage_v = 0.0
    impedance_ohm = motor.resistance_ohm + inertia_ohm
    return (voltage_v + inertia_ohm * current_a) / impedance_ohm, motor.torque_constant_n_m_a / impedance_ohm
