"""Data sheets with one trait each that real drives have: the generic simulated drive's own, changed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from sim_backend.devices.canopen.data_types import I16, U8, U32
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object, record, variable
from sim_backend.devices.canopen.objects.family import Rating
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.canopen.serve import eds_text
from sim_backend.devices.joint_tables import behind_a_drive

Place = tuple[int, int]
RPDO_TIMERS = tuple((0x1400 + number, 5) for number in range(4))
TENTH_DEGREE, INCREMENTS = 0xFF410000, 0x00B50000
PROFILE_POSITION, PROFILE_VELOCITY, PROFILE_TORQUE = 1 << 0, 1 << 2, 1 << 3  # of 0x6502


@dataclass(frozen=True)
class Trait:
    """What is different.

    Attributes:
        without: objects that are not there.
        without_places: entries that are not there.
        access, default, high, low: of entries.
        added: objects beside.
        settings: what a user has to say in bench.toml for it.
        modes: codes of 0x6060 that are used.
        is_refused: for safety's sake.
    """

    without: tuple[int, ...] = ()
    without_places: tuple[Place, ...] = ()
    access: Mapping[Place, Access] = field(default_factory=dict)
    default: Mapping[Place, int] = field(default_factory=dict)
    high: Mapping[Place, int] = field(default_factory=dict)
    low: Mapping[Place, int] = field(default_factory=dict)
    added: tuple[Object, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    modes: tuple[int, ...] = (10, 8)
    is_refused: bool = False

    def write(self, folder: Path, name: str) -> Path:
        """Write the data sheet; return its path."""
        path = folder / f"{name}.eds"
        path.write_text(eds_text(self._objects(), "CiA 402 drive of a test"), encoding="ascii")
        return path

    def _objects(self) -> list[Object]:
        objects = [self._changed(one) for one in GENERIC.objects(Rating.of(behind_a_drive()))]
        return [*(one for one in objects if one.index not in self.without and one.entries), *self.added]

    def _changed(self, one: Object) -> Object:
        entries = (entry for entry in one.entries if (one.index, entry.subindex) not in self.without_places)
        return replace(one, entries=tuple(self._entry(one.index, entry) for entry in entries))

    def _entry(self, index: int, entry: Entry) -> Entry:
        place = (index, entry.subindex)
        return replace(
            entry,
            access=self.access.get(place, entry.access),
            default=self.default.get(place, entry.default),
            high=self.high.get(place, entry.high),
            low=self.low.get(place, entry.low),
        )


def _mappings(change: Callable[[Place], Access]) -> dict[Place, Access]:
    bases = (0x1600, 0x1A00)
    places = [(base + number, place) for base in bases for number in range(4) for place in range(9)]
    return {place: change(place) for place in places}


def _beyond(places: int) -> tuple[Place, ...]:
    bases = (0x1600, 0x1A00)
    return tuple((base + n, place) for base in bases for n in range(4) for place in range(places + 1, 9))


# the default mapping of CiA 402: controlword, and controlword with a target; statusword, and with a value
_STATIC = {
    (0x1600, 0): 1, (0x1600, 1): 0x60400010,
    (0x1601, 0): 2, (0x1601, 1): 0x60400010, (0x1601, 2): 0x60710010,
    (0x1602, 0): 2, (0x1602, 1): 0x60400010, (0x1602, 2): 0x607A0020,
    (0x1A00, 0): 1, (0x1A00, 1): 0x60410010,
    (0x1A01, 0): 2, (0x1A01, 1): 0x60410010, (0x1A01, 2): 0x60610008,
    (0x1A02, 0): 2, (0x1A02, 1): 0x60410010, (0x1A02, 2): 0x60640020,
    (0x1A03, 0): 2, (0x1A03, 1): 0x60410010, (0x1A03, 2): 0x606C0020,
}  # fmt: skip
# the fifth default of CiA 402; a device has no COB-ID of its own for it
_FIFTH = (
    record(0x1404, "RPDO 5", Entry(1, "COB-ID", U32, default=0x8000_0000), Entry(2, "Transmission type", U8)),
    Object(
        0x1604,
        "RPDO 5 mapping",
        (
            Entry(0, "Number", U8, Access.CONST, 2),
            Entry(1, "First", U32, Access.CONST, 0x60400010),
            Entry(2, "Second", U32, Access.CONST, 0x60710010),
        ),
    ),
)
# one TPDO of two places, each with objects of its own that it takes
_PICKY = {(0x1A00, 1): 0x60410010, (0x1A00, 2): 0x60640020}
_NO_TORQUE_IN_FOUR = _STATIC | {(0x1601, 0): 1}
_COB_IDS = {(base + n, 1): first + 0x100 * n for base, first in ((0x1400, 0x200), (0x1800, 0x180)) for n in range(4)}
_NO_GUARD: dict[str, Any] = {"without": (0x1016, 0x100C, 0x100D), "without_places": RPDO_TIMERS}


def without_pdo(*indices: int) -> tuple[Object, ...]:
    """Objects as they are, that can be put into no PDO."""
    objects = {one.index: one.entries[0] for one in GENERIC.objects(Rating.of(behind_a_drive()))}
    return tuple(variable(index, "Effort", objects[index].kind, objects[index].access) for index in indices)


TRAITS: dict[str, Trait] = {
    "plain": Trait(),
    "fixed-sync": Trait(access={(0x1005, 0): Access.CONST}, low={(0x1005, 0): 0x80}, high={(0x1005, 0): 0x80}),
    "no-sync-object": Trait(without=(0x1005,)),
    "no-reaction-object": Trait(without=(0x6007,)),
    "no-quick-stop-object": Trait(without=(0x605A,)),
    "quick-stop-that-stays": Trait(access={(0x605A, 0): Access.CONST}, default={(0x605A, 0): 6}),
    "no-quick-stop-ramp": Trait(default={(0x6085, 0): 0}, low={(0x6085, 0): 0}),
    "life-guarding": Trait(without=(0x1016,)),
    "life-guarding-alone": Trait(without=(0x1016, 0x1017, 0x6007, 0x605A, 0x603F, 0x1029)),
    "rpdo-timer": Trait(without=(0x1016, 0x100C, 0x100D)),
    "no-guard": Trait(**_NO_GUARD, is_refused=True),
    "no-guard-but-said-so": Trait(**_NO_GUARD, settings={"watchdog_is_set_in_drive": True}, is_refused=True),
    "reaction-nothing": Trait(access={(0x6007, 0): Access.CONST}, default={(0x6007, 0): 0}, is_refused=True),
    "short-interpolation": Trait(high={(0x60C2, 1): 2}),
    "fixed-interpolation": Trait(access={(0x60C2, 1): Access.RO, (0x60C2, 2): Access.RO}),
    "two-objects-a-pdo": Trait(without_places=_beyond(2)),
    "static-mapping": Trait(access=_mappings(lambda _place: Access.CONST), default=_STATIC, without=(0x60B2,)),
    "no-torque-in-a-pdo": Trait(
        access=_mappings(lambda _place: Access.CONST), default=_NO_TORQUE_IN_FOUR, without=(0x60B2,), modes=(8,)
    ),
    "torque-in-the-fifth-pdo": Trait(
        access=_mappings(lambda _place: Access.CONST), default=_NO_TORQUE_IN_FOUR, without=(0x60B2,), added=_FIFTH
    ),
    "pdos-that-stay-on": Trait(access=dict.fromkeys(_COB_IDS, Access.RO), default=_COB_IDS),
    "one-pdo-to-send": Trait(without=(0x1801, 0x1802, 0x1803, 0x1A01, 0x1A02, 0x1A03), without_places=_beyond(3)),
    "one-pdo-of-its-own-choice": Trait(
        without=(*range(0x1801, 0x1804), *range(0x1A01, 0x1A04), 0x606C),
        without_places=_beyond(2),
        default={(0x1A00, 0): 2} | _PICKY,
        high=_PICKY,
        low={(0x1A00, 2): 0x60640020},
    ),
    "demands-that-act-as-they-come": Trait(
        access={(0x1400 + number, 2): Access.RO for number in range(4)},
        default={(0x1400 + number, 2): 254 + number % 2 for number in range(4)},
    ),
    "current-in-no-pdo": Trait(without=(0x6078,), added=(variable(0x6078, "Current actual value", I16, Access.RO),)),
    "limits-as-delivered": Trait(default={(0x6072, 0): 0, (0x6073, 0): 0}),
    "heartbeat-limited-as-a-time": Trait(
        high={(0x1016, 1): 0xFFFF, (0x1016, 2): 0xFFFF}, without=(0x100C, 0x100D), without_places=RPDO_TIMERS
    ),
    "no-current": Trait(without=(0x6075, 0x6078, 0x6073)),
    "no-torque": Trait(without=(0x6071, 0x6077, 0x6075, 0x6078), modes=(8,)),
    "no-error-code": Trait(without=(0x603F,)),
    "no-list-of-modes": Trait(without=(0x6502,)),
    "write-only-mode": Trait(access={(0x6060, 0): Access.WO}),
    "profile-position": Trait(default={(0x6502, 0): PROFILE_POSITION}, modes=(1,)),
    "profile-torque": Trait(default={(0x6502, 0): PROFILE_TORQUE | PROFILE_POSITION}, modes=(4, 1)),
    "profile-velocity": Trait(default={(0x6502, 0): PROFILE_VELOCITY}, modes=(3,)),
    "profile-without-speed": Trait(
        default={(0x6502, 0): PROFILE_POSITION, (0x6081, 0): 0, (0x6083, 0): 0, (0x6084, 0): 0},
        low={(0x6083, 0): 0, (0x6084, 0): 0},
        settings={"profile_speed_rad_s": 2.0, "profile_acceleration_rad_s2": 20.0},
        modes=(1,),
    ),
    "no-identity": Trait(without_places=((0x1018, 2), (0x1018, 3), (0x1018, 4))),
}
