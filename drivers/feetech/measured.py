"""What a servo measures, in SI."""

from math import nan

from drivers.actuator.reading import Reading
from drivers.feetech import memory
from drivers.feetech.frames import signed
from drivers.wraps import Turns


def reading_of(data: bytes, asked_s: float, turns: Turns) -> Reading:
    """The piece `memory.PIECE` in SI.

    Args:
        data: of it.
        asked_s: when it was asked for [s].
        turns: follows the position beyond one turn.
    """
    is_on, position, speed, load, supply, temperature, status, current = memory.LAYOUT.unpack(data)
    counts_s = signed(speed, memory.SPEED_SIGN)
    return Reading(
        asked_s, turns.follow(position, counts_s, asked_s), counts_s,
        signed(load, memory.LOAD_SIGN) / memory.DUTY_FULL,
        signed(current, memory.CURRENT_SIGN) * memory.CURRENT_A, nan,
        supply * memory.SUPPLY_V, temperature, bool(is_on), memory.servo_errors(status),
    )  # fmt: skip
