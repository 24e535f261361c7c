"""Permanent-magnet DC motor on a PWM stage."""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

from sim_backend.mechanisms.motor.current_sensor import CurrentSensor
from sim_backend.mechanisms.motor.dead_time import DeadTime, lost_voltage
from sim_backend.mechanisms.motor.thermal_drift import Winding
from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted

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
    """Supply and PWM stage: u = voltage * duty, the duty in whole counts of full scale.

    With a source resistance the supply sags under the current that the stage draws, and rises as the motor brakes:
    voltage = V0 - Rs duty i.
    """

    voltage_v: float = quantity("V", above=0)
    duty_counts: float = quantity("counts of full scale", at_least=1, default=1000.0)
    source_resistance_ohm: float = quantity("ohm", at_least=0, default=0.0)


@dataclass(frozen=True, kw_only=True)
class CurrentLoop(Component):
    """The drive's own current control, for drives that have it: a first-order lag, limited by the supply.

    It closes on the current as measured: gain and offset of the sensor are errors of the motor's current.
    """

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
    @property
    def current_sensor(self) -> CurrentSensor: ...  # noqa: D102
    @property
    def dead_time(self) -> DeadTime: ...  # noqa: D102


class CurrentLine(NamedTuple):
    """Motor current over a step: constant - slope * w, w the motor's mean speed [rad/s].

    Affine in the speed, so that the back-EMF damps the rotor implicitly, however small R is.

    Attributes:
        constant_a: current of a motor that stands [A].
        slope_a_s_rad: loss of current with speed.
        duty: of the stage, for what it draws from the supply.
        lost_v: voltage lost to dead time [V].
    """

    constant_a: float
    slope_a_s_rad: float
    duty: float
    lost_v: float


@jitted
def current_line(
    stage: int, demand: float, before_a: float, speed_rad_s: float, winding: Winding, supply_v: float,
    parameters: Electrics, step_s: float,
) -> CurrentLine:  # fmt: skip
    """Return the current over the coming step. Backward Euler in the inductance.

    Args:
        stage: OPEN, VOLTAGE, CURRENT or BRAKE.
        demand: duty or current [A], after the stage.
        before_a: current at the start of the step [A].
        speed_rad_s: motor speed at the start of the step [rad/s].
        winding: the motor at its temperature.
        supply_v: of the supply at this moment, without load [V].
        parameters: of the plant.
        step_s: length of the step [s].
    """
    if stage == OPEN:
        return CurrentLine(0.0, 0.0, 0.0, 0.0)
    supply, reactance_ohm = parameters.supply, parameters.motor.inductance_h / step_s
    duty, lost_v = 0.0, 0.0
    if stage == VOLTAGE:
        duty = demand
        lost_v = lost_voltage(parameters.dead_time, supply_v)
    elif stage == CURRENT:
        target_a = (demand - parameters.current_sensor.offset_a) / parameters.current_sensor.gain
        wanted_a = before_a + (target_a - before_a) * step_s / (step_s + parameters.current_loop.time_constant_s)
        needed_v = winding.torque_constant_n_m_a * speed_rad_s + reactance_ohm * (wanted_a - before_a)
        needed_v += winding.resistance_ohm * wanted_a
        if abs(needed_v) <= supply_v - supply.source_resistance_ohm * abs(wanted_a):
            return CurrentLine(wanted_a, 0.0, needed_v / supply_v, 0.0)
        duty = 1.0 if needed_v > 0.0 else -1.0
    voltage_v = duty * supply_v
    if lost_v > 0.0:
        driving_v = voltage_v + reactance_ohm * before_a - winding.torque_constant_n_m_a * speed_rad_s
        if abs(driving_v) <= lost_v:
            return CurrentLine(0.0, 0.0, duty, 0.0)
        voltage_v -= lost_v if driving_v > 0.0 else -lost_v
    impedance_ohm = winding.resistance_ohm + reactance_ohm + duty * duty * supply.source_resistance_ohm
    return CurrentLine(
        (voltage_v + reactance_ohm * before_a) / impedance_ohm,
        winding.torque_constant_n_m_a / impedance_ohm,
        duty,
        lost_v,
    )


@jitted
def winding_energy(
    stage: int, before_a: float, current_a: float, speed_rad_s: float, winding: Winding, inductance_h: float,
    step_s: float,
) -> tuple[float, float]:  # fmt: skip
    """Return (taken at the terminals, lost in the winding) over a step [J]."""
    if stage == OPEN:
        return 0.0, 0.5 * inductance_h * before_a * before_a
    change_a = current_a - before_a
    voltage_v = winding.resistance_ohm * current_a + winding.torque_constant_n_m_a * speed_rad_s
    voltage_v += inductance_h / step_s * change_a
    # backward Euler takes half the square of the change with it
    lost_j = step_s * winding.resistance_ohm * current_a * current_a + 0.5 * inductance_h * change_a * change_a
    return step_s * voltage_v * current_a, lost_j


@jitted
def stage_loss(line: CurrentLine, current_a: float, supply: Supply, step_s: float) -> float:
    """Return what the source and the stage lose over a step [J]."""
    drawn_a = line.duty * current_a
    return step_s * (supply.source_resistance_ohm * drawn_a * drawn_a + line.lost_v * abs(current_a))


@jitted
def supply_voltage(line: CurrentLine, current_a: float, supply: Supply) -> float:
    """Return the voltage at the stage [V]."""
    return supply.voltage_v - supply.source_resistance_ohm * line.duty * current_a
