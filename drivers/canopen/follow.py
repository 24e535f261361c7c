"""A CiA 402 drive that another master drives: its TPDOs are heard, whose mapping has to be known. Nothing is asked."""

from collections.abc import Mapping, Sequence
from math import nan, pi
from typing import NamedTuple

from drivers.actuator.reading import Reading
from drivers.can_bus.follower import BusFollower
from drivers.can_bus.port import CanPort, Heard
from drivers.canopen.cia301.objects import POSITION, STATUSWORD, TORQUE, VELOCITY, DriveObject
from drivers.canopen.cia402.profiles import CIA402, EPOS4
from drivers.canopen.cia402.state_machine import State, state_of
from drivers.canopen.cia402.units import VELOCITY_CODES, velocity_unit_rad_s
from drivers.canopen.settings import CanopenSettings
from drivers.errors import DriveConfigurationError
from drivers.joint import JointScale

# the first that is there tells the current: what is measured before what is relative to the rated torque
_EFFORTS = (EPOS4.current, CIA402.current, TORQUE)
Mappings = Mapping[int, Sequence[int]]
"""Entries of each TPDO (index, subindex, bits: 0x60640020) by its COB-ID, as 0x1A00 and the next have them."""


class _Place(NamedTuple):
    """Where an object is: COB-ID, first byte."""

    cob_id: int
    first: int


def follow(settings: CanopenSettings, joint: JointScale, mappings: Mappings) -> BusFollower:
    """Listen to it. A sample is taken when the last of its TPDOs comes.

    Raises:
        DriveConfigurationError: no TPDO has the position, or an entry is no whole number of bytes.
        DriveConnectionError: the bus does not open.
    """
    places = _places(settings.device, mappings)
    if POSITION.mapping not in places:
        raise DriveConfigurationError(
            settings.device,
            f"drive.tpdo_mapping has no {POSITION}: 0x{POSITION.mapping:08X} is wanted in one of its lists, such as "
            'tpdo_mapping = {"0x185" = [0x60410010, 0x60640020]}. The master or its DCF shows 0x1A00 and the next',
        )
    effort = next((item for item in _EFFORTS if item.mapping in places), None)
    ampere = _ampere(effort, settings)
    unit = settings.velocity_unit
    unit_rad_s = velocity_unit_rad_s(VELOCITY_CODES[unit], joint.counts_per_turn) if unit else None
    counts_s = nan if unit_rad_s is None else unit_rad_s / (2.0 * pi) * joint.counts_per_turn

    def value(port: CanPort, item: DriveObject | None) -> float:
        place = None if item is None else places.get(item.mapping)
        heard = None if place is None else port.last(place.cob_id)
        if item is None or place is None or heard is None or len(heard.data) < place.first + item.type.size:
            return nan
        return item.unpack(heard.data[place.first :])

    def taken(port: CanPort, heard: Heard) -> Reading | None:
        position = value(port, POSITION)
        if position != position:  # no TPDO with it has come yet
            return None
        word = value(port, STATUSWORD)
        state = (
            state_of(int(word)) if word == word else State.ENABLED
        )  # whether it is powered is not told: who moves is
        return Reading(
            heard.at_s, position, value(port, VELOCITY) * counts_s, nan, value(port, effort) * ampere,
            is_on=state is State.ENABLED, fault="fault" if state is State.FAULT else "",
        )  # fmt: skip

    last_id = max(one.cob_id for one in places.values())
    return BusFollower(settings.bus, last_id, ("CiA 402 drive", settings.device), taken, joint)


def _places(device: str, mappings: Mappings) -> dict[int, _Place]:
    """Where each object is, by its entry."""
    found = {}
    for cob_id, entries in mappings.items():
        bits = 0
        for entry in entries:
            if bits % 8:
                raise DriveConfigurationError(
                    device, f"drive.tpdo_mapping: 0x{entry:08X} of 0x{cob_id:X} begins within a byte, at bit {bits}"
                )
            found[entry] = _Place(cob_id, bits // 8)
            bits += entry & 0xFF
    return found


def _ampere(effort: DriveObject | None, settings: CanopenSettings) -> float:
    """One count of the effort [A]; NaN where it is relative to what is not known."""
    if effort is None:
        return nan
    if effort.unit != "rated current":
        return effort.scale
    return nan if settings.rated_current_a is None else effort.scale * settings.rated_current_a
