"""Numbers of the MIT protocol: each is a whole number over a range, of which every model has its own. Pure functions.

A command has five numbers in eight bytes, high bits first: position (16 bits), speed, stiffness, damping, torque (12
each). An answer has position (16), speed and torque (12 each). What a torque means depends on the range.
"""

from typing import NamedTuple

Frame = tuple[int, bytes]
"""Identifier, with `drivers.can_bus.port.EXTENDED` where it has 29 bits, and data."""

ENABLE, DISABLE, CLEAR_ERRORS = (b"\xff" * 7 + bytes((last,)) for last in (0xFC, 0xFD, 0xFB))


class Ranges(NamedTuple):
    """What the largest number of a frame means; of position, speed and torque either way.

    Attributes:
        position_rad, speed_rad_s, torque_n_m: of the actuator's output.
        damping: largest gain on the speed [N m s/rad].
    """

    position_rad: float
    speed_rad_s: float
    torque_n_m: float
    damping: float = 5.0

    @property
    def braking_damping(self) -> float:
        """The damping that asks for the whole torque at the highest speed, or the largest that its field has."""
        return min(self.torque_n_m / self.speed_rad_s, self.damping)


class Motion(NamedTuple):
    """What every answer has."""

    position_rad: float
    speed_rad_s: float
    torque_n_m: float


def to_word(value: float, full: float, bits: int) -> int:
    """The number of a value between -full and full; one beyond is taken for the end."""
    top = (1 << bits) - 1
    return round((min(max(value, -full), full) + full) / (2.0 * full) * top)


def from_word(word: int, full: float, bits: int) -> float:
    """The value of a number."""
    return word * 2.0 * full / ((1 << bits) - 1) - full


_STAND = to_word(0.0, 1.0, 16) << 48 | to_word(0.0, 1.0, 12) << 36
"""Position and speed of 0 in their places; with gains of 0 they mean nothing."""


def command(ranges: Ranges, torque_n_m: float, damping: float = 0.0) -> bytes:
    """The data of a torque, with both gains zero unless it shall damp [N m s/rad]."""
    damping_word = round(damping / ranges.damping * 0xFFF)
    word = _STAND | damping_word << 12 | to_word(torque_n_m, ranges.torque_n_m, 12)
    return word.to_bytes(8, "big")


def motion(word: int, ranges: Ranges) -> Motion:
    """The 40 bits of position, speed and torque taken apart."""
    return Motion(
        from_word(word >> 24, ranges.position_rad, 16),
        from_word(word >> 12 & 0xFFF, ranges.speed_rad_s, 12),
        from_word(word & 0xFFF, ranges.torque_n_m, 12),
    )
