"""Starts a CiA 402 drive on a CAN bus, and writes its electronic data sheet (CiA 306)."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from sim_backend.devices.can.ports import ServedOnBus, port_of
from sim_backend.devices.canopen.conduct import GOOD, Conduct
from sim_backend.devices.canopen.drive import ServoDrive
from sim_backend.devices.canopen.objects.data_sheet import read_data_sheet
from sim_backend.devices.canopen.objects.entry import Access, Entry, Object
from sim_backend.devices.canopen.objects.epos4 import EPOS4
from sim_backend.devices.canopen.objects.family import Family, Rating
from sim_backend.devices.canopen.objects.from_sheet import family_of
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.canopen.objects.homing import HOMING
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.process import RunningDevice
from sim_backend.errors import ParameterError

_IDENTITY = 0x1018
_MANDATORY = (0x1000, 0x1001, _IDENTITY)
_VARIABLE, _RECORD = 0x7, 0x9
DEFAULT_NODE = 5
FAMILIES = {family.name: family for family in (GENERIC, HOMING, EPOS4)}


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


@dataclass(frozen=True, kw_only=True)
class CanOpenSettings(ServedOnBus):
    """A drive, its joint and its bus.

    Attributes:
        family: "generic", "homing" (that one with homing) or "epos4".
        eds: data sheet or configuration file of the drive to be, instead of a family.
        node_id: 1 .. 127; None: what the file says, or 5.
    """

    family: str = "generic"
    eds: Path | None = None
    node_id: int | None = None
    conduct: Conduct = GOOD


class RunningDrive(RunningDevice):
    """A CiA 402 drive in wall-clock time."""

    device: ServoDrive

    @property
    def node_id(self) -> int:
        """Its node number."""
        return self.device.node.node_id


def serve_canopen(settings: CanOpenSettings) -> RunningDrive:
    """Start one. It boots when its port does.

    Raises:
        ParameterError: the joint cannot be, the family is not known, or the data sheet is none.
        OSError: a port is taken.
    """
    parameters = settings.joint()
    family = _family(settings.family) if settings.eds is None else family_of(read_data_sheet(settings.eds))
    node_id = settings.node_id or family.node_id or DEFAULT_NODE
    drive = ServoDrive(parameters, family, node_id, settings.seed, settings.conduct)
    return RunningDrive(
        drive, port_of(drive, settings, settings.interface, settings.channel), settings.side_port, settings.patience_s
    )


def data_sheet(family: str) -> str:
    """Return the EDS of a drive on the joint of the paper.

    Raises:
        ParameterError: the family is not known.
    """
    found = _family(family)
    return eds_text(found.objects(Rating.of(behind_a_drive())), found.device_name)


def _family(name: str) -> Family:
    if name not in FAMILIES:
        raise ParameterError(f"drive family '{name}' is unknown; known are {', '.join(FAMILIES)}")
    return FAMILIES[name]
