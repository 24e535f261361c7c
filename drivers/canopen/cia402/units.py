"""Units of CiA 402 objects: 0x60A9 (codes of CiA 303-2) and 0x60C2. Pure."""

from math import pi

VELOCITY_UNITS = ("rpm", "0.1 rpm", "0.01 rpm", "0.001 rpm", "counts/s", "rad/s", "deg/s")
"""Names of velocity units that the settings know."""

_REVOLUTION, _INCREMENT, _RADIAN, _DEGREE = 0xB4, 0xB5, 0x10, 0x41
_TIMES_S = {0x03: 1.0, 0x47: 60.0}

_CODES = {
    "rpm": 0x00B4_4700,
    "0.1 rpm": 0xFFB4_4700,
    "0.01 rpm": 0xFEB4_4700,
    "0.001 rpm": 0xFDB4_4700,
    "counts/s": 0x00B5_0300,
    "rad/s": 0x0010_0300,
    "deg/s": 0x0041_0300,
}


def velocity_unit_rad_s(code: int, counts_per_turn: float) -> float | None:
    """What one count of velocity is worth at the motor [rad/s].

    Args:
        code: as in 0x60A9: power of ten (signed), numerator, denominator, 0.
        counts_per_turn: encoder counts of a motor turn.

    Returns:
        None where the unit is no angle, or no time that is known.
    """
    angles_rad = {_REVOLUTION: 2 * pi, _INCREMENT: 2 * pi / counts_per_turn, _RADIAN: 1.0, _DEGREE: pi / 180}
    exponent = code >> 24
    exponent -= 256 if exponent > 127 else 0
    angle_rad = angles_rad.get(code >> 16 & 0xFF)
    time_s = _TIMES_S.get(code >> 8 & 0xFF)
    if angle_rad is None or time_s is None:
        return None
    return float(10.0**exponent * angle_rad / time_s)


def velocity_unit_code(name: str) -> int:
    """The code of 0x60A9 for a name of `VELOCITY_UNITS`."""
    return _CODES[name]


def velocity_unit_name(code: int) -> str:
    """The name of a code of 0x60A9; the code itself where it has none here."""
    return next((name for name, known in _CODES.items() if known == code), f"0x{code:08X}")


def interpolation_period(period_s: float) -> tuple[int, int] | None:
    """A period as 0x60C2 has it: a whole number up to 255, and the power of ten [s]; None where it has no such form."""
    for exponent in (-3, -4, -5, -6):
        number = period_s * 10.0**-exponent
        if abs(number - round(number)) < 1e-6 and 1 <= round(number) <= 255:
            return round(number), exponent
    return None
