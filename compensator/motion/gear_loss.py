"""What a gear adds to the current of a load, beyond the friction of the balanced joint.

Teeth that carry a torque rub more. Against the friction of the balanced joint, F(v), which holds none of that:

    I = (1 + d) I_load + s F(v)                         the motor drives the load (s I_load > 0)
    I = (1 - b) I_load + s F(v) + sgn(I_load) c         the load drives the motor

s is the direction of motion, d and b the shares lost in driving and in being driven back. c = (d + b) f takes up that
f, friction behind the teeth (the arm's bearings), is carried through them: it adds to their load one way and takes from
it the other. The paper's (5), (9), (10) are d = b = c = 0. At breakaway d = b shifts eq. (9) by c / 2, and makes F_load
of eq. (10) grow with the angle; d != b falsifies it in proportion to the load.
"""

from dataclasses import dataclass, fields
from math import copysign

from compensator.errors import ModelParameterError


@dataclass(frozen=True, slots=True)
class GearLoss:
    """Loss of a gear; none where left out.

    Attributes:
        driving: d, share of the transmitted torque that is lost while the motor drives the load.
        back_driving: b, while the load drives the motor; below 1.
        carried_a: c, (d + b) times the friction behind the teeth [A].
    """

    driving: float = 0.0
    back_driving: float = 0.0
    carried_a: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            if not 0.0 <= getattr(self, field.name) < float("inf"):
                raise ModelParameterError(f"{field.name} is {getattr(self, field.name)}; allowed is 0 or more")
        if self.back_driving >= 1.0:
            raise ModelParameterError(f"back_driving is {self.back_driving}; allowed is below 1: the gear locks itself")

    def load_current_a(self, current_a: float, direction: float) -> float:
        """I_load [A] from what is left of the motor current when the balanced joint's friction is taken off.

        Args:
            current_a: I - s F(v) [A].
            direction: s, 1 or -1.
        """
        if direction * current_a >= 0.0:
            return current_a / (1.0 + self.driving)
        return copysign(max(abs(current_a) - self.carried_a, 0.0), current_a) / (1.0 - self.back_driving)

    def motor_current_a(self, load_current_a: float, direction: float) -> float:
        """The inverse: I - s F(v) [A] of a load current [A]."""
        if direction * load_current_a >= 0.0:
            return load_current_a * (1.0 + self.driving)
        return load_current_a * (1.0 - self.back_driving) + copysign(self.carried_a, load_current_a)
