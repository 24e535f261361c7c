"""Between what the drive counts at the motor and what the bench sees of the joint. Pure."""

from dataclasses import dataclass
from math import isnan, nan

from drivers.canopen.cia301.objects import DriveObject
from drivers.joint import JointScale

_I16, _I32 = 0x7FFF, 0x7FFF_FFFF


@dataclass(frozen=True, slots=True)
class DriveScale:
    """Scales of one drive and its joint.

    Attributes:
        rated_current_a: motor current of 1000 permille [A]; NaN where unknown.
        velocity_unit_rad_s: one count of velocity at the motor [rad/s]; NaN where unknown.
        acceleration_unit_rad_s2: one count of acceleration at the motor [rad/s2]; NaN where the drive does not tell.
    """

    joint: JointScale
    rated_current_a: float
    velocity_unit_rad_s: float
    acceleration_unit_rad_s2: float = nan

    @property
    def velocity_rad_s(self) -> float:
        """One count of velocity at the joint [rad/s], with the encoder's sign."""
        return self.joint.encoder_sign * self.velocity_unit_rad_s / self.joint.gear_ratio

    @property
    def tells_acceleration(self) -> bool:
        """Whether the drive tells its unit of acceleration."""
        return not isnan(self.acceleration_unit_rad_s2)

    @property
    def acceleration_rad_s2(self) -> float:
        """One count of acceleration at the joint [rad/s2], without sign; of velocity a second where it is not told."""
        unit = self.acceleration_unit_rad_s2 if self.tells_acceleration else self.velocity_unit_rad_s
        return abs(unit / self.joint.gear_ratio)

    def current_a(self, item: DriveObject) -> float:
        """One count of an object that tells a motor current [A], without sign."""
        return item.scale * (self.rated_current_a if item.unit == "rated current" else 1.0)

    def tells(self, item: DriveObject) -> bool:
        """Whether a current is known from an object: one that is relative needs what it is relative to."""
        return not isnan(self.current_a(item))

    @property
    def highest_current_a(self) -> float:
        """The most that a torque demand can say [A]."""
        return _I16 * 1e-3 * self.rated_current_a

    @property
    def farthest_rad(self) -> float:
        """The farthest angle, either way, that a position demand can say [rad]."""
        return _I32 * self.joint.count_rad - abs(self.joint.zero_rad)

    def torque_permille(self, current_a: float) -> int:
        """A motor current within `highest_current_a` as torque demand; 0 is 0 whatever the rated current."""
        if current_a == 0.0:
            return 0
        return round(self.joint.motor_sign * current_a / self.rated_current_a * 1000.0)

    def velocity_counts(self, velocity_rad_s: float) -> int:
        """A joint speed as velocity demand, kept within its object."""
        return max(-_I32, min(_I32, round(velocity_rad_s / self.velocity_rad_s)))
