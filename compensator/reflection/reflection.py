"""From the load of a slave to the torque of its master's motor, and from the master's motion to the slave's set point.

    t* = T0 + g (T_load - T0), |t*| <= limit;    |dt/dt| <= slew;    master's motor: -t - b w

g is the force scale, b the damping. T0 is 0, so that the load is scaled; where a stability margin is looked for, it is
the load at rest: then g scales its changes alone, and the limit, which the load itself reaches, hides nothing of them.
What is not known (NaN) is not reflected: the torque goes to 0 as fast as it may.
"""

from dataclasses import dataclass
from math import isnan
from typing import NamedTuple

from compensator.errors import ModelParameterError


@dataclass(frozen=True, slots=True)
class Reflection:
    """The law.

    Attributes:
        force_scale: g, torque at the master per torque at the slave; 0 reflects nothing.
        torque_n_m: most that is reflected, either way.
        slew_n_m_s: fastest change of it.
        damping_n_m_s_rad: b.
        period_s: of the control loop.
        about_n_m: T0.
    """

    force_scale: float
    torque_n_m: float
    slew_n_m_s: float
    damping_n_m_s_rad: float
    period_s: float
    about_n_m: float = 0.0

    def __post_init__(self) -> None:
        if not (self.force_scale >= 0.0 and self.damping_n_m_s_rad >= 0.0):
            raise ModelParameterError("force_scale and damping_n_m_s_rad must be 0 or more")
        if not (self.torque_n_m > 0.0 and self.slew_n_m_s > 0.0 and self.period_s > 0.0):
            raise ModelParameterError("torque_n_m, slew_n_m_s and period_s must be above 0")

    def reflected_n_m(self, before_n_m: float, load_n_m: float) -> float:
        """One control cycle: the load that is reflected now [N m].

        Args:
            before_n_m: what was reflected in the cycle before.
            load_n_m: of the slave; NaN where it is not known.
        """
        changed_n_m = self.about_n_m + self.force_scale * (load_n_m - self.about_n_m)
        wanted_n_m = 0.0 if isnan(load_n_m) else changed_n_m
        wanted_n_m = min(max(wanted_n_m, -self.torque_n_m), self.torque_n_m)
        step_n_m = self.slew_n_m_s * self.period_s
        return min(max(wanted_n_m, before_n_m - step_n_m), before_n_m + step_n_m)

    def motor_n_m(self, reflected_n_m: float, master_rad_s: float) -> float:
        """Torque that the master's motor makes [N m]."""
        return -reflected_n_m - self.damping_n_m_s_rad * master_rad_s


class Followed(NamedTuple):
    """Set point of a slave: position [rad], speed [rad/s]."""

    position_rad: float
    velocity_rad_s: float


@dataclass(frozen=True, slots=True)
class Following:
    """How a slave follows its master: from where both stood when it began, scaled, within the slave's own limits.

    Attributes:
        master_rad, slave_rad: where both stood.
        scale: way of the slave per way of the master.
        low_rad, high_rad: set points of the slave.
        speed_rad_s: of the slave's set point, at most.
        period_s: of the control loop.
    """

    master_rad: float
    slave_rad: float
    scale: float
    low_rad: float
    high_rad: float
    speed_rad_s: float
    period_s: float

    def set_point(self, before_rad: float, master_rad: float, master_rad_s: float) -> Followed:
        """One control cycle: the slave's set point."""
        wanted_rad = self.slave_rad + self.scale * (master_rad - self.master_rad)
        held_rad = min(max(wanted_rad, self.low_rad), self.high_rad)
        way_rad = self.speed_rad_s * self.period_s
        given_rad = min(max(held_rad, before_rad - way_rad), before_rad + way_rad)
        # where the set point is held back it moves otherwise than the master
        velocity_rad_s = (
            self.scale * master_rad_s if given_rad == wanted_rad else (given_rad - before_rad) / self.period_s
        )
        return Followed(given_rad, velocity_rad_s)
