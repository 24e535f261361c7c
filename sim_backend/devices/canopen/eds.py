"""The dictionary as an electronic data sheet (CiA 306), for masters that want a file."""

from collections.abc import Iterable, Iterator

from sim_backend.devices.canopen.objects.entry import Access, Entry, Object

_IDENTITY = 0x1018
_MANDATORY = (0x1000, 0x1001, _IDENTITY)
_VARIABLE, _RECORD = 0x7, 0x9


def eds_text(objects: Iterable[Object], product: str) -> str:
    """Return the text of an EDS."""
    listed = sorted(objects, key=lambda one: one.index)
    identity = {entry.subindex: entry.default for one in listed if one.index == _IDENTITY for entry in one.entries}
    lines = [*_head(product, identity), *_lists(listed)]
    for one in listed:
        lines += _object(one)
    return "\n".join(lines) + "\n"


def _head(product: str, identity: dict[int, int | str]) -> Iterator[str]:
    yield from ("[FileInfo]", "FileName=friction-bench.eds", "FileVersion=1", "FileRevision=0", "EDSVersion=4.0")
    yield from (f"Description={product}", "CreatedBy=friction-bench", "ModifiedBy=friction-bench", "")
    yield from ("[DeviceInfo]", "VendorName=", f"VendorNumber={identity.get(1, 0)}", f"ProductName={product}")
    yield from (f"ProductNumber={identity.get(2, 0)}", f"RevisionNumber={identity.get(3, 0)}", "OrderCode=")
    yield from (f"BaudRate_{rate}={int(rate >= 125)}" for rate in (10, 20, 50, 125, 250, 500, 800, 1000))
    yield from ("SimpleBootUpMaster=0", "SimpleBootUpSlave=1", "Granularity=8", "DynamicChannelsSupported=0")
    yield from ("GroupMessaging=0", "NrOfRXPDO=4", "NrOfTXPDO=4", "LSS_Supported=0", "")
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
    yield f"DefaultValue={'$NODEID+' * entry.with_node_id}{_default(entry)}"
    if entry.low is not None:
        yield f"LowLimit={entry.low}"
    if entry.high is not None:
        yield f"HighLimit={entry.high}"
    yield f"PDOMapping={int(entry.mappable)}"


def _default(entry: Entry) -> str:
    """Return a default; one without sign in as many digits as it has: some readers know a mapping by no other form."""
    if isinstance(entry.default, str) or not entry.kind.layout.isupper():
        return str(entry.default)
    return f"0x{entry.default:0{2 * (entry.kind.length or 0)}X}"
