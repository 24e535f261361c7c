"""A servo's own position controller."""

from math import pi

from drivers.contract import Sample
from sim_backend.plant.parameters import PlantParameters

_BANDWIDTH_RAD_S = 40.0
_DAMPING = 0.6


class PositionHold:
    """PD on the joint's position, as motor current: the unloaded joint is a second-order system of 40 rad/s."""

    def __init__(self, parameters: PlantParameters) -> None:
        motor, ratio = parameters.motor, parameters.gear.ratio
        inertia_kg_m2 = motor.rotor_inertia_kg_m2 + parameters.arm.inertia_kg_m2 / ratio**2
        unit_a = inertia_kg_m2 * ratio / motor.torque_constant_n_m_a  # per rad/s2 of the joint
        self._proportional_a_rad = unit_a * _BANDWIDTH_RAD_S**2
        self._derivative_a_s_rad = unit_a * 2.0 * _DAMPING * _BANDWIDTH_RAD_S

    def current_a(self, target_rad: float, seen: Sample) -> float:
        """Return the motor current that takes the joint to an angle."""
        error_rad = target_rad - seen.position_rad
        return self._proportional_a_rad * error_rad - self._derivative_a_s_rad * seen.velocity_rad_s


def count_rad(parameters: PlantParameters) -> float:
    """Return the joint's angle of one count [rad]."""
    return 2.0 * pi / (parameters.encoder.counts_per_turn * parameters.gear.ratio)
