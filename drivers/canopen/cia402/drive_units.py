"""What one count of the drive is worth, by its own objects, beside what the configuration says (CiA 402-2, clause 7).

Position units a motor turn: feed constant 0x6092 / gear ratio 0x6091; or the angle that 0x60A8 names / gear ratio; or,
where positions are increments, the encoder resolution 0x608F. Velocity: the unit that 0x60A9 names, or position units
a second times the velocity factor 0x6096. Acceleration: the unit that 0x60AA names, or position units through the
acceleration factor 0x6097. Whatever contradicts the configuration is refused, and nothing is guessed.
"""

from dataclasses import dataclass
from math import isclose, nan, pi

from drivers.canopen.cia301.object_table import ObjectTable
from drivers.canopen.cia301.objects import (
    ACCELERATION_DIVISOR,
    ACCELERATION_FACTOR,
    ACCELERATION_UNIT,
    ENCODER_INCREMENTS,
    ENCODER_REVOLUTIONS,
    FEED,
    FEED_TURNS,
    GEAR_MOTOR_TURNS,
    GEAR_SHAFT_TURNS,
    POSITION_UNIT,
    VELOCITY_DIVISOR,
    VELOCITY_FACTOR,
    VELOCITY_UNIT,
    DriveObject,
)
from drivers.canopen.cia402.units import (
    VELOCITY_CODES,
    acceleration_unit_rad_s2,
    angle_rad,
    is_increments,
    velocity_unit_name,
    velocity_unit_rad_s,
)
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError

_TOLERANCE = 1e-3  # relative: an angle in round numbers is not a whole number of counts
_PURPOSE = "units"


@dataclass(frozen=True, slots=True)
class UnitRow:
    """One quantity, by the drive and by the configuration.

    Attributes:
        quantity: with its unit.
        drive: each value that the drive's objects lead to, and which they are; "" where they tell nothing.
        configuration: the value used; NaN where the quantity counts as not measured.
    """

    quantity: str
    drive: str
    configuration: float


@dataclass(frozen=True, slots=True)
class DriveUnits:
    """What was found.

    Attributes:
        velocity_rad_s: one count of velocity at the motor [rad/s]; NaN where neither drive nor settings tell.
        acceleration_rad_s2: one count of acceleration at the motor [rad/s2]; NaN where the drive does not tell.
        told_counts: counts of a motor turn, by the drive; NaN where it tells none.
    """

    velocity_rad_s: float
    acceleration_rad_s2: float
    rows: tuple[UnitRow, ...]
    told_counts: float


@dataclass(frozen=True, slots=True)
class _Told:
    """A value by the drive, and the objects behind it."""

    value: float
    source: str

    def __str__(self) -> str:
        return f"{self.value:.6g} by {self.source}"


def read_units(table: ObjectTable, settings: CanopenSettings, counts_per_turn: float) -> DriveUnits:
    """Read the drive's units, and compare them.

    Raises:
        DriveConfigurationError: the drive contradicts the rig or the settings, or itself.
    """
    gear = _ratio(table, GEAR_MOTOR_TURNS, GEAR_SHAFT_TURNS) or 1.0
    positions = _positions(table, gear)
    velocities = _velocities(table, gear, counts_per_turn)
    _check_positions(positions, settings, counts_per_turn)
    velocity_rad_s = _velocity(velocities, settings, counts_per_turn)
    return DriveUnits(
        velocity_rad_s,
        _acceleration(table, gear, counts_per_turn),
        (
            UnitRow("counts per motor turn", _words(positions), counts_per_turn),
            UnitRow("one count of velocity at the motor in rad/s", _words(velocities), velocity_rad_s),
        ),
        positions[0].value if positions else nan,
    )


def _positions(table: ObjectTable, gear: float) -> list[_Told]:
    """Position units of a motor turn, by each way that the drive offers."""
    feed = _ratio(table, FEED, FEED_TURNS)
    encoder = _ratio(table, ENCODER_INCREMENTS, ENCODER_REVOLUTIONS)
    code = table.ask(POSITION_UNIT, _PURPOSE) or 0
    turned = "" if gear == 1.0 else f" and gear ratio 0x6091 ({gear:g})"
    told = []
    if feed is not None and feed != 1.0:  # one unit a turn is what stands there before anybody has set it
        told.append(_Told(feed / gear, f"feed constant 0x6092 ({feed:g}){turned}"))
    unit_rad = angle_rad(code)
    if unit_rad is not None:
        told.append(_Told(2.0 * pi / unit_rad / gear, f"position unit 0x60A8 (0x{code:08X}){turned}"))
    if told or encoder is None or not (code == 0 or is_increments(code)):
        return told
    told.append(_Told(encoder, f"encoder resolution 0x608F ({encoder:g})"))
    if gear != 1.0:  # drives differ in whether increments are of the motor or of the shaft
        told.append(_Told(encoder / gear, f"encoder resolution 0x608F ({encoder:g}){turned}"))
    return told


def _velocities(table: ObjectTable, gear: float, counts_per_turn: float) -> list[_Told]:
    """One count of velocity at the motor [rad/s], by each way that the drive offers."""
    code = table.ask(VELOCITY_UNIT, _PURPOSE) or 0
    factor = _ratio(table, VELOCITY_FACTOR, VELOCITY_DIVISOR)
    unit_rad_s = velocity_unit_rad_s(code, counts_per_turn)
    told = []
    if unit_rad_s is not None:
        at_motor = 1.0 if is_increments(code) else gear
        told.append(_Told(unit_rad_s * at_motor, f"{VELOCITY_UNIT}, which is {velocity_unit_name(code)}"))
    if factor is not None and (unit_rad_s is None or factor != 1.0):
        told.append(_Told(2.0 * pi / counts_per_turn / factor, f"velocity factor 0x6096 ({factor:g})"))
    return told


def _check_positions(told: list[_Told], settings: CanopenSettings, counts_per_turn: float) -> None:
    if not told or settings.units_from_configuration or any(_same(one.value, counts_per_turn) for one in told):
        return
    raise DriveConfigurationError(
        settings.device,
        f"counts per motor turn are {_words(told)}; the rig says {counts_per_turn:g}. Correct sensor.counts_per_turn "
        "of the rig, or the objects of the drive; with units_from_configuration = true the rig is believed",
    )


def _velocity(told: list[_Told], settings: CanopenSettings, counts_per_turn: float) -> float:
    if settings.velocity_unit is not None:
        configured = velocity_unit_rad_s(VELOCITY_CODES[settings.velocity_unit], counts_per_turn)
        assert configured is not None
        if told and not settings.units_from_configuration and not any(_same(one.value, configured) for one in told):
            raise DriveConfigurationError(
                settings.device,
                f"one count of velocity is {_words(told)} [rad/s]; the settings say {settings.velocity_unit}, "
                f"{configured:.6g} rad/s. Correct velocity_unit, or leave it out to use the drive's",
            )
        return configured
    if len(told) > 1 and not _same(told[0].value, told[1].value):
        raise DriveConfigurationError(
            settings.device,
            f"one count of velocity is {_words(told)} [rad/s]: the drive contradicts itself. Set velocity_unit to the "
            "one that is right",
        )
    return told[0].value if told else nan


def _acceleration(table: ObjectTable, gear: float, counts_per_turn: float) -> float:
    """One count of acceleration at the motor [rad/s2]; NaN where the drive tells no unit that is known here."""
    code = table.ask(ACCELERATION_UNIT, _PURPOSE)
    if code:
        unit_rad_s2 = acceleration_unit_rad_s2(code, counts_per_turn)
        return nan if unit_rad_s2 is None else unit_rad_s2 * (1.0 if is_increments(code) else gear)
    factor = _ratio(table, ACCELERATION_FACTOR, ACCELERATION_DIVISOR)
    if factor is not None and factor != 1.0:  # one is what stands there before anybody has set it
        return 2.0 * pi / counts_per_turn / factor
    return nan


def _ratio(table: ObjectTable, over: DriveObject, under: DriveObject) -> float | None:
    """A fraction that two objects tell; None where one of them is absent or 0."""
    numerator, divisor = table.ask(over, _PURPOSE), table.ask(under, _PURPOSE)
    return numerator / divisor if numerator and divisor else None


def _same(one: float, other: float) -> bool:
    return isclose(one, other, rel_tol=_TOLERANCE)


def _words(told: list[_Told]) -> str:
    return ", or ".join(map(str, told))
