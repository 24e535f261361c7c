"""How far a joint may run that no position servo holds, whether that is used up, and from where on it slips."""

from dataclasses import dataclass
from math import ceil
from typing import Self

import numpy as np

from bench.config.configuration import BenchConfiguration
from bench.control.cycle import Reading
from compensator.lab.recordings.recording import FloatArray

MARGIN_RAD = 0.15  # at either limit, for what the servo overshoots when it brakes
SPEED_SHARE = 0.85  # of the limit: braking begins there, before the limit trips
BRAKING_SHARE = 0.3  # of motion.acceleration_rad_s2: a heavy arm is braked by less than a free one is moved with


@dataclass(frozen=True, slots=True)
class Excursion:
    """Where the joint may run freely.

    Attributes:
        low_rad, high_rad: ends.
        speed_rad_s: top speed, either way.
        braking_rad_s2: with which it is braked before an end.
        period_s: of control.
        reaction_s: until braking begins; longer where the power stage has to be switched on first.
    """

    low_rad: float
    high_rad: float
    speed_rad_s: float
    braking_rad_s2: float
    period_s: float
    reaction_s: float = 0.0

    @classmethod
    def of(cls, configuration: BenchConfiguration, centre_rad: float = 0.0, reach_rad: float | None = None) -> Self:
        """What the limits leave; with a reach, no farther than that from a centre."""
        limits = configuration.limits
        low_rad, high_rad = limits.position_min_rad + MARGIN_RAD, limits.position_max_rad - MARGIN_RAD
        if reach_rad is not None:
            low_rad, high_rad = max(low_rad, centre_rad - reach_rad), min(high_rad, centre_rad + reach_rad)
        braking = BRAKING_SHARE * configuration.motion.acceleration_rad_s2
        return cls(low_rad, high_rad, SPEED_SHARE * limits.speed_rad_s, braking, configuration.control.period_s)

    def used_up(self, reading: Reading) -> str:
        """What is used up, in words; "" while the joint may go on."""
        position_rad, speed_rad_s = reading.sample.position_rad, reading.velocity_rad_s
        if abs(speed_rad_s) >= self.speed_rad_s:
            return f"the speed reached {speed_rad_s:.3g} rad/s; allowed is {self.speed_rad_s:.3g} rad/s either way"
        if speed_rad_s == 0.0:
            return ""
        left_rad = self.high_rad - position_rad if speed_rad_s > 0.0 else position_rad - self.low_rad
        speed_rad_s = abs(speed_rad_s)
        stopping_rad = speed_rad_s * (2.0 * self.period_s + self.reaction_s)
        stopping_rad += speed_rad_s**2 / (2.0 * self.braking_rad_s2)
        if left_rad <= stopping_rad:
            return f"at {position_rad:.4g} rad the way to {self.low_rad:.4g} .. {self.high_rad:.4g} rad was used up"
        return ""


LEAST_COUNTS = 3.0  # that the slip speed makes between two positions compared; fewer may be noise


def comparing_cycles(slip_speed_rad_s: float, period_s: float, count_rad: float) -> int:
    """Over how many cycles a speed can be told from rest."""
    return max(1, ceil(LEAST_COUNTS * count_rad / (slip_speed_rad_s * period_s)))


def slip_index(way_rad: FloatArray, slip_speed_rad_s: float, period_s: float, count_rad: float) -> int:
    """The last reading before the joint slips: from there on it is faster than the slip speed, to the end of the push.

    Args:
        way_rad: along the push, shape (n,); it ends beyond all free play.
        slip_speed_rad_s: speed that pre-sliding and creep stay below.
        period_s: of control.
        count_rad: of the encoder, at the joint.

    Returns:
        An index of `way_rad`; 0 where it slips from the start.
    """
    cycles = comparing_cycles(slip_speed_rad_s, period_s, count_rad)
    moved_rad = way_rad[cycles:] - way_rad[:-cycles]
    slow = np.flatnonzero(moved_rad <= slip_speed_rad_s * cycles * period_s)
    return int(slow[-1]) + cycles if len(slow) else 0
