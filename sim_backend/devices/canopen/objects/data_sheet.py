"""Reading an electronic data sheet or a device configuration file (CiA 306): which objects a device has."""

from configparser import ConfigParser, Error, SectionProxy
from dataclasses import dataclass
from pathlib import Path

from sim_backend.devices.canopen.data_types import TYPES, U8
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object
from sim_backend.errors import ParameterError

_LISTS = ("MandatoryObjects", "OptionalObjects", "ManufacturerObjects")
_NODE_ID = "$NODEID"
_VARIABLES = (0x2, 0x7)  # object types that are one value: domain, variable


@dataclass(frozen=True, slots=True)
class DataSheet:
    """What a file says of a device.

    Attributes:
        name: of the product, or of the file where it has none.
        objects: all that it lists.
        told: places with a value in the file.
        node_id: of a device that is configured already; None: any.
    """

    name: str
    objects: tuple[Object, ...]
    told: frozenset[tuple[int, int]]
    node_id: int | None

    def default(self, index: int, subindex: int = 0) -> int | None:
        """Return a number that the file tells; None where it does not."""
        if (index, subindex) not in self.told:
            return None
        found = next(one for one in self.objects if one.index == index)
        value = next(entry.default for entry in found.entries if entry.subindex == subindex)
        return value if isinstance(value, int) else None


def read_data_sheet(path: Path) -> DataSheet:
    """Read a file.

    Raises:
        ParameterError: it cannot be read, or is no data sheet.
    """
    parser = ConfigParser(interpolation=None, strict=False, inline_comment_prefixes=(";",))
    try:
        parser.read_string(path.read_text(encoding="latin-1"))
    except (OSError, Error) as error:
        raise ParameterError(f"data sheet {path}: {error}") from error
    sections = {name.lower(): parser[name] for name in parser.sections()}
    try:
        objects = [made for index in _listed(sections) if (made := _object(index, sections)) is not None]
    except (KeyError, ValueError) as error:
        raise ParameterError(f"data sheet {path}: {error} is missing or no number") from error
    if not objects:
        raise ParameterError(f"data sheet {path}: lists no objects in [{'], ['.join(_LISTS)}]")
    told = frozenset((one.index, entry.subindex) for one, entries in objects for entry in entries)
    device = sections.get("deviceinfo")
    name = device.get("ProductName", "").strip() if device is not None else ""
    return DataSheet(name or path.stem, tuple(one for one, _ in objects), told, _node_id(sections))


Made = tuple[Object, list[Entry]]
"""An object, and those of its entries to which the file gives a value."""


def _node_id(sections: dict[str, SectionProxy]) -> int | None:
    # the misspelled name is that of the standard
    section = sections.get("devicecomissioning") or sections.get("devicecommissioning")
    node_id = _number(section["NodeID"]) if section is not None and section.get("NodeID") else 0
    return node_id if 1 <= node_id <= 127 else None


def _listed(sections: dict[str, SectionProxy]) -> list[int]:
    indices: set[int] = set()
    for name in _LISTS:
        section = sections.get(name.lower())
        if section is not None:
            indices |= {_number(value) for key, value in section.items() if key.isdigit()}
    return sorted(indices)


def _object(index: int, sections: dict[str, SectionProxy]) -> Made | None:
    """Return an object; None where it is listed and not described."""
    section = sections.get(f"{index:04x}")
    if section is None:
        return None
    name = section.get("ParameterName", f"0x{index:04X}")
    kind = _number(section.get("ObjectType") or "0x7")
    if kind in _VARIABLES and not _number(section.get("SubNumber") or "0"):
        found = [_entry(0, section)]
    elif _number(section.get("CompactSubObj") or "0"):
        found = _compact(section, sections.get(f"{index:04x}value"))
    else:
        places = (place for place in range(255) if f"{index:04x}sub{place:x}" in sections)
        found = [_entry(place, sections[f"{index:04x}sub{place:x}"]) for place in places]
    if not found:
        return None
    return Object(index, name, tuple(entry for entry, _ in found)), [entry for entry, told in found if told]


def _compact(section: SectionProxy, values: SectionProxy | None) -> list[tuple[Entry, bool]]:
    """Return the entries of an array that is told in one section."""
    count = _number(section["CompactSubObj"])
    entries = [(Entry(0, "Highest sub-index supported", U8, Access.CONST, count), True)]
    for place in range(1, count + 1):
        value = None if values is None else values.get(str(place))
        entries.append(_entry(place, section, value))
    return entries


def _entry(place: int, section: SectionProxy, value: str | None = None) -> tuple[Entry, bool]:
    """Return an entry, and whether the file gives it a value: of a configured device its own, else the default."""
    kind = TYPES.get(_number(section.get("DataType") or "0x5"), U8)
    text = value or (section.get("ParameterValue") or section.get("DefaultValue") or "").strip()
    low, high = section.get("LowLimit") or "", section.get("HighLimit") or ""
    with_node_id = _NODE_ID in text.upper()
    default: int | str = text
    if kind.length is not None:
        default = _signed(_number(text.upper().replace(_NODE_ID, "").strip(" +") or "0"), kind.range)
    limits = _limits(low, high, kind.range) if kind.length is not None else (None, None)
    entry = Entry(
        subindex=place,
        name=section.get("ParameterName", ""),
        kind=kind,
        access=_access(section.get("AccessType", "rw")),
        default=default,
        mappable=bool(_number(section.get("PDOMapping") or "0")),
        low=limits[0],
        high=limits[1],
        with_node_id=with_node_id,
    )
    return entry, bool(text)


def _access(text: str) -> Access:
    try:
        return Access(text.strip().lower())
    except ValueError:
        return Access.RW


def _limits(low: str, high: str, whole: tuple[int, int]) -> tuple[int | None, int | None]:
    """Return the limits of writing; those that contradict each other, or that carry the node's number, are none."""
    bounds = [_signed(_number(text), whole) if _is_number(text) else None for text in (low, high)]
    if None not in bounds and (bounds[0] > bounds[1] or bounds == [0, 0]):  # type: ignore[operator]
        return None, None
    return bounds[0], bounds[1]


def _is_number(text: str) -> bool:
    try:
        _number(text)
    except ValueError:
        return False
    return True


def _number(text: str) -> int:
    """Return a number: 0x before a hexadecimal, 0 before an octal, else decimal.

    Raises:
        ValueError: it is none.
    """
    text = text.strip()
    if len(text) > 1 and text[0] == "0" and text.isdigit():
        return int(text, 8) if set(text) <= set("01234567") else int(text)
    return int(text, 0)


def _signed(value: int, whole: tuple[int, int]) -> int:
    """Return a number within a type's range: a negative one may be written as its bits."""
    low, high = whole
    return value - (high - low + 1) if value > high and low < 0 else value
