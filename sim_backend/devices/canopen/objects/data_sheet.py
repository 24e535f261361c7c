"""Reading an electronic data sheet or a device configuration file (CiA 306): which objects a device has."""

import codecs
import re
from configparser import ConfigParser, Error, SectionProxy
from dataclasses import dataclass
from pathlib import Path
from struct import pack

from sim_backend.devices.canopen.data_types import TYPES, U8, DataType
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object
from sim_backend.errors import ParameterError

_OBJECT = re.compile("[0-9a-f]{4}")
_SUBINDEX = re.compile(r"([0-9a-f]{4})\s*sub\s*(?:0x)?0*([0-9a-f]+)")
_NODE_ID = "$NODEID"
_DOMAIN = 0x2
_VARIABLES = (_DOMAIN, 0x7)  # object types that are one value: domain, variable
_REALS = {0x08: "<f", 0x11: "<d"}
_IDENTITY = {"1018sub1": "VendorNumber", "1018sub2": "ProductNumber", "1018sub3": "RevisionNumber"}  # of [DeviceInfo]
_ENCODINGS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}


@dataclass(frozen=True, slots=True)
class DataSheet:
    """What a file says of a device.

    Attributes:
        name: of the product, or of the file where it has none.
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
    parser = ConfigParser(interpolation=None, strict=False, inline_comment_prefixes=(";", "//"))
    try:
        parser.read_string(_plain(_text(path)), path.name)
        sections = _sections(parser)
        objects = [made for index in _described(sections) if (made := _object(index, sections)) is not None]
    except (OSError, ValueError, Error) as error:
        raise ParameterError(f"data sheet {path}: {' '.join(str(error).split())}") from error
    if not objects:
        raise ParameterError(f"data sheet {path}: describes no objects, in sections such as [1000]")
    told = frozenset((one.index, entry.subindex) for one, entries in objects for entry in entries)
    device = sections.get("deviceinfo")
    name = device.get("ProductName", "").strip() if device is not None else ""
    return DataSheet(name or path.stem, tuple(one for one, _ in objects), told, _node_id(sections))


def _text(path: Path) -> str:
    """Return the text of a file; one without a mark of its encoding is read byte by byte: only names may suffer."""
    data = path.read_bytes()
    encoding = next((name for mark, name in _ENCODINGS.items() if data.startswith(mark)), _unmarked(data))
    text = data.decode(encoding)
    if text.lstrip().startswith("<"):
        raise ValueError("is XML (XDD, XDC, ESI); an EDS or DCF file is wanted: save it as one in the maker's tool")
    return text


def _unmarked(data: bytes) -> str:
    """Return an encoding by where the zero bytes are: of text in UTF-16 nearly every other byte is one."""
    most = 0.9 * (len(data) // 2)
    places = {"utf-16-be": data[0::2], "utf-16-le": data[1::2]}
    return next((name for name, half in places.items() if half.count(0) > most), "latin-1")


def _plain(text: str) -> str:
    """Return a text line by line for its reader: lines that end alike, no indents, no title, no mark of the end.

    Raises:
        ValueError: a byte is in it that no text has.
    """
    lines = [line.strip() for line in re.split("\r\n?|\n", text.rstrip("\0\x1a \t\r\n"))]
    for number, line in enumerate(lines, 1):
        if found := re.search("[\0\x1a]", line):
            raise ValueError(f"line {number} has byte 0x{ord(found[0]):02X}; text is wanted: save it anew")
    first = next((place for place, line in enumerate(lines) if line.startswith("[")), 0)
    # a line with a value is no title: its section is missing
    return "\n".join([*("" if "=" not in line else line for line in lines[:first]), *lines[first:]])


def _sections(parser: ConfigParser) -> dict[str, SectionProxy]:
    """Return sections by their name in lower case, the subindex without leading zeros.

    Raises:
        ValueError: one is there twice under two spellings, and says different things.
    """
    sections: dict[str, SectionProxy] = {}
    for name in parser.sections():
        section = parser[name]
        before = sections.setdefault(_SUBINDEX.sub(r"\1sub\2", name.strip().lower()), section)
        if before is not section and dict(before) != dict(section):
            raise ValueError(f"[{before.name}] and [{name}] are one object, and differ; leave one of them")
    return sections


Made = tuple[Object, list[Entry]]
"""An object, and those of its entries to which the file gives a value."""


def _node_id(sections: dict[str, SectionProxy]) -> int | None:
    # the misspelled name is that of the standard
    section = sections.get("devicecomissioning") or sections.get("devicecommissioning")
    node_id = 0 if section is None else _field(section, "NodeID")
    return node_id if 1 <= node_id <= 127 else None


def _described(sections: dict[str, SectionProxy]) -> list[int]:
    """Return what has a section; the lists of a file often leave some out, or number two alike."""
    return sorted(int(name, 16) for name in sections if _OBJECT.fullmatch(name))


def _object(index: int, sections: dict[str, SectionProxy]) -> Made | None:
    """Return an object; None where a section tells nothing of what is in it."""
    section = sections[f"{index:04x}"]
    name = section.get("ParameterName", f"0x{index:04X}")
    if _field(section, "ObjectType", "0x7") in _VARIABLES and not _field(section, "SubNumber"):
        found = [_entry(0, section)]
    elif _field(section, "CompactSubObj"):
        found = _compact(section, sections.get(f"{index:04x}value"))
    else:
        names = {place: f"{index:04x}sub{place:x}" for place in range(255)}
        found = [
            _entry(place, sections[name], absent=_identity(name, sections))
            for place, name in names.items()
            if name in sections
        ]
    if not found:
        return None
    return Object(index, name, tuple(entry for entry, _ in found)), [entry for entry, told in found if told]


def _compact(section: SectionProxy, values: SectionProxy | None) -> list[tuple[Entry, bool]]:
    """Return the entries of an array that is told in one section."""
    count = _field(section, "CompactSubObj")
    entries = [(Entry(0, "Highest sub-index supported", U8, Access.CONST, count), True)]
    for place in range(1, count + 1):
        value = None if values is None else values.get(str(place))
        entries.append(_entry(place, section, value))
    return entries


def _identity(name: str, sections: dict[str, SectionProxy]) -> str:
    """Return what [DeviceInfo] says of an entry of 0x1018: many files tell it nowhere else; "" of any other."""
    device = sections.get("deviceinfo")
    return "" if device is None or name not in _IDENTITY else device.get(_IDENTITY[name], "")


def _entry(place: int, section: SectionProxy, value: str | None = None, absent: str = "") -> tuple[Entry, bool]:
    """Return an entry, and whether the file gives it a value: of a configured device its own, else the default.

    Args:
        place: its subindex.
        section: of the file.
        value: told elsewhere, before that of the section.
        absent: told elsewhere, where the section has none.
    """
    untyped = "0xF" if _field(section, "ObjectType", "0x7") == _DOMAIN else ""  # any other has to name its type
    kind = TYPES.get(_field(section, "DataType", untyped), U8)
    text = value or (section.get("ParameterValue") or section.get("DefaultValue") or absent).strip()
    told = _value(text, kind)
    whole = None if kind.length is None or kind.code in _REALS else kind.range
    limits = (None, None) if whole is None else _limits(section.get("LowLimit"), section.get("HighLimit"), whole)
    entry = Entry(
        subindex=place,
        name=section.get("ParameterName", ""),
        kind=kind,
        access=_access(section.get("AccessType", "rw")),
        default=told if told is not None else "" if kind.length is None else 0,
        mappable=bool(_field(section, "PDOMapping")),
        low=limits[0],
        high=limits[1],
        with_node_id=_NODE_ID in text.upper(),
    )
    return entry, told is not None


def _value(text: str, kind: DataType) -> int | str | None:
    """Return a value of a type; None where the text is none of it: then the file does not tell the value."""
    if not text or kind.length is None:
        return text or None
    try:
        if kind.code in _REALS:
            return _real(text, kind)
        return _signed(_number(text.upper().replace(_NODE_ID, "").strip(" +") or "0"), kind.range)
    except (ValueError, OverflowError):
        return None


def _real(text: str, kind: DataType) -> int:
    """Return the bits of a real number; a hexadecimal one is written as its bits."""
    if not text.lower().startswith("0x"):
        return int.from_bytes(pack(_REALS[kind.code], float(text)), "little")
    bits = _number(text)
    if bits > kind.range[1]:
        raise ValueError
    return bits


def _access(text: str) -> Access:
    try:
        return Access(text.strip().lower())
    except ValueError:
        return Access.RW


def _limits(low: str | None, high: str | None, whole: tuple[int, int]) -> tuple[int | None, int | None]:
    """Return the limits of writing; those that contradict each other, or that carry the node's number, are none."""
    bounds = [_limit(text or "", whole) for text in (low, high)]
    if None not in bounds and (bounds[0] > bounds[1] or bounds == [0, 0]):  # type: ignore[operator]
        return None, None
    return bounds[0], bounds[1]


def _limit(text: str, whole: tuple[int, int]) -> int | None:
    try:
        return _signed(_number(text), whole)
    except ValueError:
        return None


def _field(section: SectionProxy, key: str, absent: str = "0") -> int:
    """Return the number of a key."""
    text = section.get(key) or absent
    try:
        return _number(text)
    except ValueError:
        raise ValueError(f"[{section.name}] {key} is '{text}'; a number is wanted") from None


def _number(text: str) -> int:
    """Return a number: 0x before a hexadecimal or h after it, 0 before an octal, else decimal.

    Raises:
        ValueError: it is none.
    """
    text = text.strip()
    if len(text) > 1 and text[0] == "0" and text.isdigit():
        return int(text, 8) if set(text) <= set("01234567") else int(text)
    return int(text[:-1], 16) if text[-1:] in ("h", "H") else int(text, 0)


def _signed(value: int, whole: tuple[int, int]) -> int:
    """Return a number within a type's range: a negative one may be written as its bits."""
    low, high = whole
    return value - (high - low + 1) if value > high and low < 0 else value
