"""Mesh loss: friction of the gear that grows with the torque it transmits."""

from dataclasses import dataclass

from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class LoadFriction(Component):
    """Dry friction in proportion to the transmitted torque, after the direction of power.

        F = driving |T|        where the motor drives the load  (T w > 0)
        F = back_driving |T|   where the load drives the motor  (T w < 0)

    An efficiency of 80 % is driving = 0.25. Sliding teeth lose more one way than the other: two coefficients.
    """

    driving: float = quantity("1", at_least=0, default=0.0)
    back_driving: float = quantity("1", at_least=0, at_most=1, default=0.0)


@jitted
def mesh_loss(load_friction: LoadFriction, torque_n_m: float, direction: float) -> float:
    """Return the friction torque [N m] against motion in a direction (+1, -1) while the gear carries a torque."""
    if torque_n_m * direction > 0.0:
        return load_friction.driving * abs(torque_n_m)
    return load_friction.back_driving * abs(torque_n_m)
