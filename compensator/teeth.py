"""Where the teeth of a gear are in their free play, by the model: the sensor before it does not see the arm.

The torque that the teeth have to pass on, as motor current at the joint,

    c = I_load + J_arm dw/dt + s f          s the direction of motion, f the friction behind the teeth

presses them together on one flank. When it changes its sign, as it does where an arm swings past the bottom, the arm
falls through the free play, J_arm d2x/dt2 = c against the flank that it leaves, until it has come the whole of it.
Meanwhile, and until it has stopped rattling there, motor current tells nothing of the load.
"""

from math import copysign
from typing import NamedTuple


class Teeth(NamedTuple):
    """What is remembered of the teeth.

    Attributes:
        flank: that they touch, or have left last: the sign of the torque; 0 before anything is known.
        apart_rad, apart_rad_s: how far from it the arm is, and how fast it leaves.
        crossing_cycles: for how long they have been apart, or were the last time.
        touch_cycles: since they touched.
    """

    flank: float = 0.0
    apart_rad: float = 0.0
    apart_rad_s: float = 0.0
    crossing_cycles: int = 0
    touch_cycles: int = 0

    def touch_since(self, cycles: int) -> bool:
        """Whether they have touched for so many cycles after the rattle, taken to last as long as the crossing."""
        return self.flank == 0.0 or (self.apart_rad == 0.0 and self.touch_cycles > cycles + self.crossing_cycles)


def follow(
    teeth: Teeth, torque_a: float, unsure_a: float, inertia_a_s2_rad: float, free_play_rad: float, period_s: float
) -> Teeth:
    """One control cycle.

    Args:
        teeth: before.
        torque_a: c.
        unsure_a: c may be wrong by so much; by less than that nothing leaves its flank.
        inertia_a_s2_rad: J_arm, above 0.
        free_play_rad: backlash, at the joint.
        period_s: of the control loop.
    """
    if teeth.flank == 0.0:
        return Teeth(copysign(1.0, torque_a))
    leaving_a = -teeth.flank * torque_a
    if teeth.apart_rad == 0.0 and leaving_a <= unsure_a:
        return teeth._replace(touch_cycles=teeth.touch_cycles + 1)
    apart_rad_s = teeth.apart_rad_s + leaving_a / inertia_a_s2_rad * period_s
    apart_rad = teeth.apart_rad + apart_rad_s * period_s
    crossing_cycles = 1 if teeth.apart_rad == 0.0 else teeth.crossing_cycles + 1
    if apart_rad >= free_play_rad:
        return Teeth(-teeth.flank, 0.0, 0.0, crossing_cycles)
    if apart_rad > 0.0:
        return teeth._replace(apart_rad=apart_rad, apart_rad_s=apart_rad_s, crossing_cycles=crossing_cycles)
    return Teeth(teeth.flank, 0.0, 0.0, crossing_cycles)
