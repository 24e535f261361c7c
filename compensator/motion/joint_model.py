"""What was identified of a joint, for whoever takes the load out of its motor current while it moves."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, sin
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from compensator.errors import ModelParameterError
from compensator.motion.friction_lookup import FrictionLookup
from compensator.motion.gear_loss import GearLoss
from compensator.motion.kinetic_friction import KineticFriction

NO_LOSS = GearLoss()
FloatArray = NDArray[np.float64]


class MotionFriction(Protocol):
    """What a joint in motion takes beyond inertia and load, where more is known of it than friction curves."""

    def current_a(
        self, position_rad: FloatArray, speed_rad_s: FloatArray, acceleration_rad_s2: float, teeth_a: FloatArray,
        gravity_a: float, temperature_c: float,
    ) -> FloatArray:  # fmt: skip
        """Current [A] at each of some moments in one direction, shape (n,); the load's gear losses are in it."""


@dataclass(frozen=True, slots=True)
class JointUnderLoad:
    """The joint with what selects its friction curve given: everything that an estimate needs, in plain numbers.

    Attributes:
        ratio: motor turns per joint turn.
        lighter, heavier, share: the curves on either side, and how far from the one to the other.
        offset_a, rise_offset_a: what friction is more forwards, and less backwards; what that rises by towards rest.
        rotor_inertia_a_s2_rad, arm_inertia_a_s2_rad: current per joint acceleration, before and behind the teeth.
        gravity_a: current that the load takes at 90 degrees.
        gear_loss: of the teeth under load.
        friction_scatter: standard deviation of friction about its curve, as a share of it.
        studied: takes the place of the curves and of the gear loss in motion; None: there is nothing better.
    """

    ratio: float
    lighter: KineticFriction
    heavier: KineticFriction
    share: float
    offset_a: float
    rise_offset_a: float
    rotor_inertia_a_s2_rad: float
    arm_inertia_a_s2_rad: float
    gravity_a: float
    gear_loss: GearLoss
    friction_scatter: float
    studied: MotionFriction | None = None

    def about_to_move_a(self, current_a: float, way: float, margin: float = 1.0) -> float:
        """I_load [A] of the joint at rest that is just about to move in a direction, with `margin` of the friction."""
        return self.gear_loss.load_current_a(current_a - margin * self.friction_a(0.0, way), way)

    def friction_a(self, joint_speed_rad_s: float, direction: float) -> float:
        """s F(v) [A]: friction of the balanced joint in a direction, at a speed of the joint or next to 0."""
        speed = abs(joint_speed_rad_s) * self.ratio
        light, heavy, share = _rise(self.lighter, speed), _rise(self.heavier, speed), self.share
        light_a, heavy_a = _sliding_a(self.lighter, light, speed), _sliding_a(self.heavier, heavy, speed)
        unequal_a = self.offset_a + self.rise_offset_a * (light + share * (heavy - light))
        return direction * max(light_a + share * (heavy_a - light_a), 0.0) + unequal_a

    @property
    def arm_friction_a(self) -> float:
        """Friction behind the teeth [A], as what they lose of it tells: `GearLoss.carried_a`."""
        loss = self.gear_loss
        return loss.carried_a / (loss.driving + loss.back_driving) if loss.carried_a > 0.0 else 0.0

    @property
    def inertia_a_s2_rad(self) -> float:
        """Current per joint acceleration of rotor, arm and load together; 0 where it is not known."""
        return self.rotor_inertia_a_s2_rad + self.arm_inertia_a_s2_rad

    def gravity_at(self, angle_rad: float) -> float:
        """What the load takes at an angle [A]."""
        return self.gravity_a * sin(angle_rad)


@dataclass(frozen=True)
class JointModel:
    """What was identified of the joint, over what selects its friction curve.

    Attributes:
        friction: of the balanced joint, over the speed of the motor shaft.
        ratio: motor turns per joint turn.
        rotor_inertia_a_s2_rad: current per joint acceleration, of what turns before the teeth.
        arm_inertia_a_s2_rad: of arm and load behind the teeth, at each selector of `friction`.
        offsets_a, rise_offsets_a: what friction is more forwards, and less backwards, at each selector, and what that
            rises by towards rest; none where left out.
        gravity_a: current that the load takes at 90 degrees (angle 0 is down), at each selector; none where left out.
            Between the moment that an estimate in motion belongs to and now, the load is taken to change by that.
        gear_loss: of the teeth under load.
        friction_scatter: standard deviation of friction about its curve, as a share of it.
        studied: takes the place of the curves and of the gear loss in motion; None: there is nothing better.
    """

    friction: FrictionLookup
    ratio: float
    rotor_inertia_a_s2_rad: float
    arm_inertia_a_s2_rad: tuple[float, ...]
    offsets_a: tuple[float, ...] = ()
    rise_offsets_a: tuple[float, ...] = ()
    gravity_a: tuple[float, ...] = ()
    gear_loss: GearLoss = NO_LOSS
    friction_scatter: float = 0.03
    studied: MotionFriction | None = None

    def __post_init__(self) -> None:
        wanted = len(self.friction.selectors)
        for name in ("arm_inertia_a_s2_rad", "offsets_a", "rise_offsets_a", "gravity_a"):
            found = len(getattr(self, name))
            if found != wanted and not (name != "arm_inertia_a_s2_rad" and found == 0):
                raise ModelParameterError(f"{name} has {found} values; allowed is one per curve, {wanted}")
        if not self.ratio > 0.0 or not self.friction_scatter >= 0.0:
            raise ModelParameterError("ratio must be above 0, friction_scatter 0 or more")

    def within(self, selector: float) -> float:
        """The selector, or the nearest that the look-up allows."""
        low, high = self.friction.allowed()
        return min(max(selector, low), high)

    def under(self, selector: float) -> JointUnderLoad:
        """The joint at one selector.

        Raises:
            LookupRangeError: further outside of the calibrated ones than the look-up allows.
        """
        below, share = self.friction.place(selector)

        def at(values: Sequence[float]) -> float:
            return values[below] + share * (values[below + 1] - values[below]) if values else 0.0

        return JointUnderLoad(
            self.ratio,
            self.friction.curves[below],
            self.friction.curves[below + 1],
            share,
            at(self.offsets_a),
            at(self.rise_offsets_a),
            self.rotor_inertia_a_s2_rad,
            max(at(self.arm_inertia_a_s2_rad), 0.0),
            at(self.gravity_a),
            self.gear_loss,
            self.friction_scatter,
            self.studied,
        )


def _rise(curve: KineticFriction, speed: float) -> float:
    """How much of the rise towards rest is left at a speed, 0 or more: 1 next to rest."""
    return exp(-((speed / curve.stribeck_speed_rad_s) ** curve.shape))


def _sliding_a(curve: KineticFriction, rise: float, speed: float) -> float:
    """Eq. (2) of one speed, 0 or more: the limit next to 0 included."""
    return curve.coulomb_a + (curve.static_a - curve.coulomb_a) * rise + curve.viscous_a_s_rad * speed
