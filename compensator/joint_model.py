"""What was identified of a joint, for whoever takes the load out of its motor current while it moves."""

from dataclasses import dataclass
from math import sin

from compensator.errors import ModelParameterError
from compensator.friction_lookup import FrictionLookup
from compensator.gear_loss import GearLoss

NO_LOSS = GearLoss()
CREEP_RAD_S = 1e-6  # of the motor: the curve's value next to speed 0


@dataclass(frozen=True)
class JointModel:
    """What was identified of the joint.

    Attributes:
        friction: of the balanced joint, over the speed of the motor shaft.
        ratio: motor turns per joint turn.
        rotor_inertia_a_s2_rad: current per joint acceleration, of what turns before the teeth.
        arm_inertia_a_s2_rad: of arm and load behind the teeth, at each selector of `friction`.
        offsets_a: what friction is more forwards, and less backwards, at each selector; none where left out.
        gravity_a: current that the load takes at 90 degrees (angle 0 is down), at each selector; none where left out.
            Between the moment that an estimate in motion belongs to and now, the load is taken to change by that.
        gear_loss: of the teeth under load.
        friction_scatter: standard deviation of friction about its curve, as a share of it.
    """

    friction: FrictionLookup
    ratio: float
    rotor_inertia_a_s2_rad: float
    arm_inertia_a_s2_rad: tuple[float, ...]
    offsets_a: tuple[float, ...] = ()
    gravity_a: tuple[float, ...] = ()
    gear_loss: GearLoss = NO_LOSS
    friction_scatter: float = 0.03

    def __post_init__(self) -> None:
        wanted = len(self.friction.selectors)
        for name in ("arm_inertia_a_s2_rad", "offsets_a", "gravity_a"):
            found = len(getattr(self, name))
            if found != wanted and not (name != "arm_inertia_a_s2_rad" and found == 0):
                raise ModelParameterError(f"{name} has {found} values; allowed is one per curve, {wanted}")
        if not self.ratio > 0.0 or not self.friction_scatter >= 0.0:
            raise ModelParameterError("ratio must be above 0, friction_scatter 0 or more")

    def friction_a(self, joint_speed_rad_s: float, direction: float, selector: float) -> float:
        """s F(v) [A]: friction of the balanced joint in a direction, at a speed of the joint or next to 0."""
        speed = direction * max(abs(joint_speed_rad_s) * self.ratio, CREEP_RAD_S)
        return float(self.friction.current_a(speed, selector)) + self._at(self.offsets_a, selector)

    def arm_inertia_at(self, selector: float) -> float:
        """Current per joint acceleration of what hangs behind the teeth [A s2/rad]."""
        return self._at(self.arm_inertia_a_s2_rad, selector)

    def gravity_at(self, angle_rad: float, selector: float) -> float:
        """What the load takes at an angle [A]."""
        return self._at(self.gravity_a, selector) * sin(angle_rad)

    def within(self, selector: float) -> float:
        """The selector, or the nearest that the look-up allows."""
        low, high = self.friction.allowed()
        return min(max(selector, low), high)

    def _at(self, values: tuple[float, ...], selector: float) -> float:
        return self.friction.between(values, selector) if values else 0.0
