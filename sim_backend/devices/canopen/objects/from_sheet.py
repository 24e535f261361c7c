"""A family made from a data sheet: what a host can reach is the file's; what makes the drive work is behind it."""

from collections.abc import Callable
from dataclasses import replace
from math import pi

from sim_backend.devices.canopen.objects.communication import MOST_PDOS, PDOS, pdos
from sim_backend.devices.canopen.objects.data_sheet import DataSheet
from sim_backend.devices.canopen.objects.entry import Entry, Object
from sim_backend.devices.canopen.objects.epos4 import EPOS4, MAXON
from sim_backend.devices.canopen.objects.family import Family, Rating, increment, mode_bits, with_defaults
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.canopen.objects.homing import homing_objects

_DEVICE_NAME, _CONSUMER_HEARTBEAT, _HOMING_METHOD, _SUPPORTED_MODES = 0x1008, 0x1016, 0x6098, 0x6502
_HOMING = 6  # of 0x6060
_OF_EPOS4 = frozenset({(0x3001, 2), (0x30D1, 2)})  # where it keeps limit and current; maxon's drives before it do not
_LINK_TO_MAPPING = 0x1400 ^ 0x1600  # from the communication parameter of a PDO to its mapping parameter, and back
# what whoever commissions a drive enters for the motor on it; a data sheet cannot know it
_OF_THE_MOTOR = frozenset({(0x6075, 0), (0x6076, 0), (0x608F, 1), (0x608F, 2), (0x3001, 1), (0x3001, 2), (0x3001, 5)})
_LIMITS = frozenset({(0x6072, 0), (0x6073, 0)})  # of the motor as well, where they are delivered as 0: no torque at all
_REVOLUTION, _RADIAN, _DEGREE = 0xB4, 0x10, 0x41  # of CiA 303-2
_INCREMENT_PER_S2, _RPM_PER_S = (0xB5, 0x57), (0xC0, 0x03)  # numerator and denominator; the second is maxon's
_ANGLES_RAD = {_REVOLUTION: 2.0 * pi, _RADIAN: 1.0, _DEGREE: pi / 180.0}
_TIMES_S = {0x03: 1.0, 0x47: 60.0}
_ACCELERATIONS_RAD_S2 = {(numerator, 0x57): angle_rad for numerator, angle_rad in _ANGLES_RAD.items()} | {
    _RPM_PER_S: 2.0 * pi / 60.0
}


def family_of(sheet: DataSheet) -> Family:
    """Return the drive that a data sheet describes, on whatever motor it is put."""
    name = f"{sheet.name}, simulated"
    places = {(one.index, entry.subindex) for one in sheet.objects for entry in one.entries}
    base = EPOS4 if sheet.default(0x1018, 1) == MAXON and places >= _OF_EPOS4 else GENERIC
    modes = _modes(sheet) or base.modes | ({_HOMING} if (_HOMING_METHOD, 0) in places else set())
    return Family(
        name=sheet.name,
        device_name=name,
        modes=modes,
        objects=lambda rating: _objects(
            sheet, with_defaults(base.objects(rating), {_SUPPORTED_MODES: mode_bits(modes)}), rating
        ),
        velocity_rad_s=_velocity_unit(sheet),
        acceleration_rad_s2=_acceleration_unit(sheet),
        torque_unit_n_m=base.torque_unit_n_m,
        peak=base.peak,
        position_rad=_position_unit(sheet),
        own_objects=base.own_objects & places if base is EPOS4 else frozenset(),
        node_id=sheet.node_id,
    )


def _modes(sheet: DataSheet) -> frozenset[int]:
    bits = sheet.default(_SUPPORTED_MODES) or 0
    return frozenset(mode for mode in range(1, 12) if bits >> (mode - 1) & 1)


def _objects(sheet: DataSheet, base: list[Object], rating: Rating) -> list[Object]:
    """The file's objects, and hidden ones for whatever the drive works with beside them."""
    listed = {one.index for one in sheet.objects}
    homing = homing_objects(rating) if _HOMING_METHOD in listed else ()
    more = [
        one for one in pdos(range(PDOS, MOST_PDOS)) if one.index in listed or one.index ^ _LINK_TO_MAPPING in listed
    ]
    inside = {one.index: one for one in (*homing, *more, *base)}
    made = [_visible(one, inside.pop(one.index, None), sheet) for one in sheet.objects]
    return [*made, *(_hidden(one) for one in inside.values())]


def _visible(one: Object, base: Object | None, sheet: DataSheet) -> Object:
    behind = {entry.subindex: entry for entry in base.entries} if base is not None else {}
    entries = [_entry(one.index, entry, behind.pop(entry.subindex, None), sheet) for entry in one.entries]
    if one.index == _DEVICE_NAME:  # no record of it may be taken for one of hardware
        entries = [replace(entries[0], default=f"{entries[0].default or sheet.name}, simulated"[:60])]
    rest = tuple(replace(entry, hidden=True) for entry in behind.values())
    return replace(one, entries=(*entries, *rest))


def _entry(index: int, entry: Entry, behind: Entry | None, sheet: DataSheet) -> Entry:
    place = (index, entry.subindex)
    if index == _CONSUMER_HEARTBEAT and entry.high is not None and entry.high >> 16 == 0:
        entry = replace(entry, high=None)  # of the time alone: node 0, which is none, would be all that it lets in
    if behind is None or type(behind.default) is not type(entry.default):
        return entry
    if place not in sheet.told or place in _OF_THE_MOTOR or (place in _LIMITS and not entry.default):
        return replace(entry, default=behind.default, with_node_id=behind.with_node_id)
    return entry


def _hidden(one: Object) -> Object:
    """An object that works inside; a PDO that no host can reach does not exist."""
    absent_pdo = 0x1400 <= one.index < 0x1600 or 0x1800 <= one.index < 0x1A00
    return replace(
        one,
        entries=tuple(
            replace(
                entry,
                hidden=True,
                default=entry.default | 0x8000_0000
                if absent_pdo and entry.subindex == 1 and isinstance(entry.default, int)
                else entry.default,
            )
            for entry in one.entries
        ),
    )


def _ratio(sheet: DataSheet, index: int) -> float | None:
    """Subindex 1 over subindex 2; None where the file does not tell them."""
    over, under = sheet.default(index, 1), sheet.default(index, 2)
    return over / under if over and under else None


def _position_unit(sheet: DataSheet) -> Callable[[float], float]:
    """Motor angle of one unit of position [rad]: by feed and gear (0x6092, 0x6091), by 0x60A8, or an increment."""
    gear = _ratio(sheet, 0x6091) or 1.0
    feed = _ratio(sheet, 0x6092)
    if feed is not None and feed != 1.0:
        return lambda _turn: 2.0 * pi * gear / feed
    code = sheet.default(0x60A8) or 0
    angle_rad = _ANGLES_RAD.get(code >> 16 & 0xFF)
    if angle_rad is None:
        return increment
    return lambda _turn: angle_rad * 10.0 ** _exponent(code) * gear


def _velocity_unit(sheet: DataSheet) -> Callable[[float], float]:
    """Motor speed of one unit of velocity [rad/s]: by 0x60A9, by 0x6096, or a unit of position a second."""
    position = _position_unit(sheet)
    gear = _ratio(sheet, 0x6091) or 1.0
    code = sheet.default(0x60A9) or 0
    angle_rad, time_s = _ANGLES_RAD.get(code >> 16 & 0xFF), _TIMES_S.get(code >> 8 & 0xFF)
    if angle_rad is not None and time_s is not None:
        return lambda _turn: angle_rad * 10.0 ** _exponent(code) / time_s * gear
    factor = _ratio(sheet, 0x6096) or 1.0
    return lambda turn: position(turn) / factor


def _acceleration_unit(sheet: DataSheet) -> Callable[[float], float]:
    """Motor acceleration of one unit of acceleration [rad/s2]: by 0x60AA, by 0x6097, or a unit of velocity a second."""
    position = _position_unit(sheet)
    gear = _ratio(sheet, 0x6091) or 1.0
    code = sheet.default(0x60AA) or 0
    unit = (code >> 16 & 0xFF, code >> 8 & 0xFF)
    if unit in _ACCELERATIONS_RAD_S2:
        return lambda _turn: _ACCELERATIONS_RAD_S2[unit] * 10.0 ** _exponent(code) * gear
    factor = 10.0 ** -_exponent(code) if unit == _INCREMENT_PER_S2 else _ratio(sheet, 0x6097)
    return _velocity_unit(sheet) if factor is None else lambda turn: position(turn) / factor


def _exponent(code: int) -> int:
    exponent = code >> 24 & 0xFF
    return exponent - 256 if exponent > 127 else exponent
