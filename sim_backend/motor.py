"""Permanent-magnet DC motor on a PWM stage."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

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


class Electrics(Protocol):
    """The components that make the motor current; the plant's parameters have them."""

    @property
    def motor(self) -> Motor: ...  # noqa: D102
    @property
    def supply(self) -> Supply: ...  # noqa: D102
    @property
    def current_loop(self) -> CurrentLoop: ...  # noqa: D102


class CurrentLine(NamedTuple):
    """Motor current over a step: constant - slope * w, w the motor's mean speed [rad/s].

    Affine in the speed, so that the back-EMF damps the rotor implicitly, however small R is.
    """

    constant_a: float
    slope_a_s_rad: float


@jitted
def current_line(
    stage: int, demand: float, before_a: float, speed_rad_s: float, parameters: Electrics, step_s: float
) -> CurrentLine:
    """Return the current over the coming step. Backward Euler in the inductance.

    Args:
        stage: OPEN, VOLTAGE, CURRENT or BRAKE.
        demand: duty or current [A], after the stage.
        before_a: current at the start of the step [A].
        speed_rad_s: motor speed at the start of the step [rad/s].
        parameters: of the plant.
        step_s: length of the step [s].
    """
    motor, supply = parameters.motor, parameters.supply
    if stage == OPEN:
        return CurrentLine(0.0, 0.0)
    reactance_ohm = motor.inductance_h / step_s
    voltage_v = 0.0
    if stage == VOLTAGE:
        voltage_v = demand * supply.voltage_v
    elif stage == CURRENT:
        wanted_a = before_a + (demand - before_a) * step_s / (step_s + parameters.current_loop.time_constant_s)
        needed_v = motor.torque_constant_n_m_a * speed_rad_s + reactance_ohm * (wanted_a - before_a)
        needed_v += motor.resistance_ohm * wanted_a
        if abs(needed_v) <= supply.voltage_v:
            return CurrentLine(wanted_a, 0.0)
        voltage_v = supply.voltage_v if needed_v > 0.0 else -supply.voltage_v
    impedance_ohm = motor.resistance_ohm + reactance_ohm
    return CurrentLine(
        (voltage_v + reactance_ohm * before_a) / impedance_ohm, motor.torque_constant_n_m_a / impedance_ohm
    )


@jitted
def electrical_energy(
    stage: int, before_a: float, current_a: float, speed_rad_s: float, motor: Motor, step_s: float
) -> tuple[float, float]:
    """Return (drawn from the supply, lost in the winding) over a step [J]."""
    if stage == OPEN:
        return 0.0, 0.5 * motor.inductance_h * before_a * before_a
    change_a = current_a - before_a
    voltage_v = motor.resistance_ohm * current_a + motor.torque_constant_n_m_a * speed_rad_s
    voltage_v += motor.inductance_h * change_a / step_s
    # backward Euler takes half the square of the change with it
    lost_j = step_s * motor.resistance_ohm * current_a * current_a + 0.5 * motor.inductance_h * change_a * change_a
    return step_s * voltage_v * current_a, lost_j
