"""Motor, winding, power stage and current sensor."""

from math import cos, pi, sin

from sim_backend.second_plant.compiled import compiled
from sim_backend.second_plant.physics import REFERENCE_C, Physics


@compiled
def winding_ohm(p: Physics, winding_c: float) -> float:
    """Resistance at a temperature."""
    return p.resistance_ohm * (1.0 + p.copper_per_k * (winding_c - REFERENCE_C))


@compiled
def sensed(p: Physics, current: float, bias_a: float) -> float:
    """What the sensor gives for a current [A]."""
    return current * (1.0 + (p.current_gain if current > 0.0 else -p.current_gain)) + bias_a


@compiled
def power_stage(p: Physics, asked_v: float, current: float, busy: float) -> tuple[float, float]:
    """Voltage at the motor and of the supply; blanking takes some of it, against the current."""
    duty = asked_v / p.supply_v
    bus = p.supply_v - p.source_ohm * abs(current * duty) - p.other_axis_v * busy
    duty = min(max(duty, -1.0), 1.0)
    return duty * bus - p.dead_time_v * min(max(current / (0.02 * p.supply_v / p.resistance_ohm), -1.0), 1.0), bus


@compiled
def motor_n_m(p: Physics, current: float, angle: float) -> float:
    """Torque of the motor, with saturation, ripple and commutation off by the sensor's error."""
    constant = p.torque_per_a
    if p.saturation_a > 0.0:
        constant /= 1.0 + (current / p.saturation_a) ** 2
    motor = angle * p.turns
    if p.ripple_share != 0.0:
        constant *= 1.0 + p.ripple_share * sin(6.0 * p.pole_pairs * motor)
    if p.interpolation_rad != 0.0:
        off = p.interpolation_rad * p.turns * sin(p.interpolation_order * p.pole_pairs * motor + 0.25 * pi)
        constant *= cos(p.pole_pairs * off)
    torque = constant * current + p.torque_step_n_m
    if p.cogging_n_m != 0.0:
        torque -= p.cogging_n_m * sin(p.cogging_per_turn * motor)
    return torque
