"""From what a drive counts to what the joint does: encoder counts, gear ratio, signs and zero."""

from dataclasses import dataclass, field
from math import isfinite, nan, pi

_STANDING_CYCLES = 3


@dataclass(frozen=True, slots=True)
class JointScale:
    """How a drive's counts and signs map to the joint. Angle 0 is vertically down.

    Attributes:
        counts_per_turn: encoder counts per motor turn, after quadrature (four per line).
        gear_ratio: motor turns per joint turn.
        motor_sign: 1 where a positive demand turns the joint to positive angles, -1 where it turns it back.
        encoder_sign: 1 where the count rises with the angle, -1 where it falls.
        zero_rad: the angle that the counts alone amount to while the joint is at angle 0 [rad].
        count_rad: the joint angle of one count [rad].

    Raises:
        ValueError: a value that no joint has.
    """

    counts_per_turn: float
    gear_ratio: float
    motor_sign: int = 1
    encoder_sign: int = 1
    zero_rad: float = 0.0
    count_rad: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("counts_per_turn", "gear_ratio"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0.0):
                raise ValueError(f"{name} is {value}; a positive number is wanted")
        for name in ("motor_sign", "encoder_sign"):
            if getattr(self, name) not in (1, -1):
                raise ValueError(f"{name} is {getattr(self, name)}; 1 or -1 is wanted")
        if not isfinite(self.zero_rad):
            raise ValueError(f"zero_rad is {self.zero_rad} rad; a finite angle is wanted")
        object.__setattr__(self, "count_rad", 2.0 * pi / (self.counts_per_turn * self.gear_ratio))

    def position_rad(self, counts: float) -> float:
        """Joint angle of a count [rad]."""
        return self.encoder_sign * counts * self.count_rad - self.zero_rad

    def velocity_rad_s(self, counts_s: float) -> float:
        """Joint speed of counts per second [rad/s]."""
        return self.encoder_sign * counts_s * self.count_rad

    def counts(self, position_rad: float) -> int:
        """Count nearest to a joint angle [rad]."""
        return round(self.encoder_sign * (position_rad + self.zero_rad) / self.count_rad)


class Standstill:
    """When a quick stop is over, where the drive does not say so: its count stands. Followed from cycle to cycle."""

    def __init__(self) -> None:
        self._last = nan  # a position that is not known never stands
        self._cycles = 0

    def restart(self) -> None:
        """Braking begins."""
        self._last, self._cycles = nan, 0

    def stands(self, position: float) -> bool:
        """Whether the position, in any unit, has been the same for some cycles; this one's is given."""
        self._cycles = self._cycles + 1 if position == self._last else 0
        self._last = position
        return self._cycles >= _STANDING_CYCLES
