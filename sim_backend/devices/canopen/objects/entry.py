"""What a table of objects is made of."""

from dataclasses import dataclass
from enum import Enum

from sim_backend.devices.canopen.data_types import U8, DataType


class Access(Enum):
    """Access by SDO, as an EDS names it."""

    CONST = "const"
    RO = "ro"
    WO = "wo"
    RW = "rw"
    RWR = "rwr"  # of what may be put into PDOs: into TPDOs alone
    RWW = "rww"  # into RPDOs alone

    @property
    def writable(self) -> bool:
        """Whether a host may write it."""
        return self not in (Access.CONST, Access.RO)


@dataclass(frozen=True, slots=True)
class Entry:
    """One value of the dictionary.

    Attributes:
        subindex: its number in the object.
        default: after a reset.
        mappable: into PDOs: a readable one into TPDOs, a writable one into RPDOs too.
        low, high: narrower than the type, where not None.
        with_node_id: the node's number is added to the default.
        hidden: the drive works with it, and no host can reach it.
    """

    subindex: int
    name: str
    kind: DataType
    access: Access = Access.RW
    default: int | str = 0
    mappable: bool = False
    low: int | None = None
    high: int | None = None
    with_node_id: bool = False
    hidden: bool = False

    def fits(self, received: bool) -> bool:
        """Whether it may be put into an RPDO, or else into a TPDO."""
        if not self.mappable or self.hidden:
            return False
        return self.access.writable and self.access is not Access.RWR if received else self.access is not Access.WO


@dataclass(frozen=True, slots=True)
class Object:
    """An index of the dictionary: one variable, or a record with its highest subindex at 0."""

    index: int
    name: str
    entries: tuple[Entry, ...]

    @property
    def is_variable(self) -> bool:
        """Whether it is one value alone."""
        return len(self.entries) == 1 and self.entries[0].subindex == 0


def variable(index: int, name: str, kind: DataType, access: Access = Access.RW, default: int | str = 0,
             **more: object) -> Object:  # fmt: skip
    """Return an object that is one value."""
    return Object(index, name, (Entry(0, name, kind, access, default, **more),))  # type: ignore[arg-type]


def record(index: int, name: str, *entries: Entry) -> Object:
    """Return an object of several values; the highest subindex is put before them."""
    highest = Entry(0, "Highest sub-index supported", U8, Access.CONST, entries[-1].subindex)
    return Object(index, name, (highest, *entries))
