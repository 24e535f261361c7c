"""Units of CiA 402 objects: 0x60A8, 0x60A9 and 0x60AA (codes of CiA 303-2), 0x60C2. Pure."""

from math import pi
from typing import Literal, get_args

VelocityUnit = Literal["rpm", "0.1 rpm", "0.01 rpm", "0.001 rpm", "counts/s", "rad/s", "deg/s"]
VELOCITY_UNITS: tuple[str, ...] = get_args(VelocityUnit)
"""Names of velocity units that the settings know."""

_REVOLUTION, _INCREMENT, _RADIAN, _DEGREE = 0xB4, 0xB5, 0x10, 0x41
_TIMES_S = {0x03: 1.0, 0x47: 60.0}
_SECOND, _SECOND_SQUARED, _RPM = 0x03, 0x57, 0xC0  # of accelerations; maxon has "rpm a second"

VELOCITY_CODES = {
    "rpm": 0x00B4_4700,
    "0.1 rpm": 0xFFB4_4700,
    "0.01 rpm": 0xFEB4_4700,
    "0.001 rpm": 0xFDB4_4700,
    "counts/s": 0x00B5_0300,
    "rad/s": 0x0010_0300,
    "deg/s": 0x0041_0300,
}
"""Codes of 0x60A9."""


def angle_rad(code: int) -> float | None:
    """What one count of position is worth by 0x60A8, as an angle of the shaft [rad]; None where it is no angle."""
    unit_rad = {_REVOLUTION: 2 * pi, _RADIAN: 1.0, _DEGREE: pi / 180}.get(code >> 16 & 0xFF)
    return None if unit_rad is None else float(10.0 ** _exponent(code) * unit_rad)


def is_increments(code: int) -> bool:
    """Whether a code of 0x60A8 or 0x60A9 counts increments."""
    return code >> 16 & 0xFF == _INCREMENT


def velocity_unit_rad_s(code: int, counts_per_turn: float) -> float | None:
    """What one count of velocity is worth [rad/s], of the shaft; of increments, at the motor.

    Args:
        code: as in 0x60A9: power of ten (signed), numerator, denominator, 0.
        counts_per_turn: encoder counts of a motor turn.

    Returns:
        None where the unit is no angle, or no time that is known.
    """
    time_s = _TIMES_S.get(code >> 8 & 0xFF)
    unit_rad = _turned_rad(code, counts_per_turn)
    return None if unit_rad is None or time_s is None else unit_rad / time_s


def acceleration_unit_rad_s2(code: int, counts_per_turn: float) -> float | None:
    """What one count of acceleration is worth by 0x60AA [rad/s2], of the shaft; of increments, at the motor.

    Args:
        code: power of ten (signed), numerator, denominator, 0.
        counts_per_turn: encoder counts of a motor turn.

    Returns:
        None where the unit is not known.
    """
    numerator, denominator = code >> 16 & 0xFF, code >> 8 & 0xFF
    if (numerator, denominator) == (_RPM, _SECOND):
        return float(10.0 ** _exponent(code) * 2 * pi / 60.0)
    return _turned_rad(code, counts_per_turn) if denominator == _SECOND_SQUARED else None


def _turned_rad(code: int, counts_per_turn: float) -> float | None:
    """What one count turns [rad]; None where it is no angle."""
    return float(10.0 ** _exponent(code) * 2 * pi / counts_per_turn) if is_increments(code) else angle_rad(code)


def _exponent(code: int) -> int:
    exponent = code >> 24 & 0xFF
    return exponent - 256 if exponent > 127 else exponent


def velocity_unit_name(code: int) -> str:
    """The name of a code of 0x60A9; the code itself where it has none here."""
    return next((name for name, known in VELOCITY_CODES.items() if known == code), f"0x{code:08X}")


def interpolation_periods(period_s: float, exponent: int | None) -> list[tuple[int, int]]:
    """A period in each form that 0x60C2 has for it: a whole number up to 255, and the power of ten [s].

    Args:
        period_s: the period [s].
        exponent: the one that stands in the drive already: its form comes first.
    """
    forms = []
    for power in (-3, -4, -5, -6):
        number = period_s * 10.0**-power
        if abs(number - round(number)) < 1e-6 and 1 <= round(number) <= 255:
            forms.append((round(number), power))
    return sorted(forms, key=lambda form: form[1] != exponent)
