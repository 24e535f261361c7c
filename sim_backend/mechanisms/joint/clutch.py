"""A clutch between transmission and arm that slips when it is overloaded, or worn."""

from dataclasses import dataclass

from sim_backend.mechanisms.joint.contact import Gear, flank, penetration
from sim_backend.plant.component import Component, quantity
from sim_backend.plant.jit import jitted


@dataclass(frozen=True, kw_only=True)
class Clutch(Component):
    """It carries torque up to its limit and slips there; the limit 0 is a rigid coupling.

    What has slipped is lost to the encoder: motor angle / ratio and joint angle do not find together again.
    """

    limit_n_m: float = quantity("N m", at_least=0, default=0.0)


@jitted
def carried(clutch: Clutch, torque_n_m: float) -> float:
    """Return what the clutch carries of a torque [N m]."""
    if clutch.limit_n_m == 0.0:
        return torque_n_m
    return min(max(torque_n_m, -clutch.limit_n_m), clutch.limit_n_m)


@jitted
def slipped(gear: Gear, stiffness_n_m_rad: float, torque_n_m: float, apart_rad: float) -> float:
    """Return the angle that has slipped [rad] when the teeth carry a torque and rotor and arm are so far apart."""
    side = flank(gear, apart_rad) if gear.backlash_rad == 0.0 else (1.0 if torque_n_m > 0.0 else -1.0)
    return penetration(gear, side, apart_rad) - torque_n_m / stiffness_n_m_rad
