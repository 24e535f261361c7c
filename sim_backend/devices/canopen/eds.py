"""The dictionary as an electronic data sheet (CiA 306), for masters that want a file."""

from collections.abc import Iterable, Iterator

from sim_backend.devices.canopen.objects.entry import Access, Entry, Object

_MANDATORY = (0x1000, 0x1001, 0x1018)
_VARIABLE, _RECORD = 0x7, 0x9


def eds_text(objects: Iterable[Object], product: str, vendor: int) -> str:
    """Return the text of an EDS."""
    listed = sorted(objects, key=lambda one: one.index)
    lines = [*_head(product, vendor), *_lists(listed)]
    for one in listed:
        lines += _object(one)
    return "\n".join(lines) + "\n"


def _head(product: str, vendor: int) -> Iterator[str]:
    yield from ("[FileInfo]", "FileName=friction-bench.eds", "FileVersion=1", "FileRevision=0", "EDSVersion=4.0")
    yield from (f"Description={product}", "")
    yield from ("[DeviceInfo]", "VendorName=", f"VendorNumber={vendor}", f"ProductName={product}")
    yield from (f"BaudRate_{rate}=1" for rate in (125, 250, 500, 800, 1000))
    yield from ("SimpleBootUpSlave=1", "Granularity=8", "NrOfRXPDO=4", "NrOfTXPDO=4", "")
    yield "[DummyUsage]"  # readers want all seven
    yield from (f"Dummy{number:04d}=0" for number in range(1, 8))
    yield ""


def _lists(objects: list[Object]) -> Iterator[str]:
    mandatory = [one for one in objects if one.index in _MANDATORY]
    own = [one for one in objects if 0x2000 <= one.index < 0x6000]
    others = [one for one in objects if one not in mandatory and one not in own]
    for name, some in (("Mandatory", mandatory), ("Optional", others), ("Manufacturer", own)):
        yield f"[{name}Objects]"
        yield f"SupportedObjects={len(some)}"
        yield from (f"{number}=0x{one.index:04X}" for number, one in enumerate(some, 1))
        yield ""


def _object(one: Object) -> Iterator[str]:
    yield f"[{one.index:04X}]"
    yield f"ParameterName={one.name}"
    if one.is_variable:
        yield f"ObjectType=0x{_VARIABLE:X}"
        yield from _value(one.entries[0])
    else:
        yield f"ObjectType=0x{_RECORD:X}"
        yield f"SubNumber={len(one.entries)}"
        for entry in one.entries:
            yield from ("", f"[{one.index:04X}sub{entry.subindex:X}]", f"ParameterName={entry.name}")
            yield f"ObjectType=0x{_VARIABLE:X}"
            yield from _value(entry)
    yield ""


def _value(entry: Entry) -> Iterator[str]:
    yield f"DataType=0x{entry.kind.code:04X}"
    access = entry.access.value
    yield f"AccessType={'rww' if entry.mappable and entry.access is Access.RW else access}"
    default = entry.default if isinstance(entry.default, str) else f"{entry.default}"
    yield f"DefaultValue={f'$NODEID+{entry.default:#x}' if entry.with_node_id else default}"
    if entry.low is not None:
        yield f"LowLimit={entry.low}"
    if entry.high is not None:
        yield f"HighLimit={entry.high}"
    yield f"PDOMapping={int(entry.mappable)}"
