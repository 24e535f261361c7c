"""Starts a CiA 402 drive on a CAN bus."""

from dataclasses import dataclass
from pathlib import Path

from sim_backend.devices.can.ports import ServedOnBus, port_of
from sim_backend.devices.canopen.conduct import GOOD, Conduct
from sim_backend.devices.canopen.drive import ServoDrive
from sim_backend.devices.canopen.eds import eds_text
from sim_backend.devices.canopen.objects.data_sheet import read_data_sheet
from sim_backend.devices.canopen.objects.epos4 import EPOS4
from sim_backend.devices.canopen.objects.family import Family, Rating
from sim_backend.devices.canopen.objects.from_sheet import family_of
from sim_backend.devices.canopen.objects.generic import GENERIC
from sim_backend.devices.canopen.objects.homing import HOMING
from sim_backend.devices.joint_tables import behind_a_drive
from sim_backend.devices.process import RunningDevice
from sim_backend.errors import ParameterError

DEFAULT_NODE = 5
FAMILIES = {family.name: family for family in (GENERIC, HOMING, EPOS4)}


@dataclass(frozen=True, kw_only=True)
class CanOpenSettings(ServedOnBus):
    """A drive, its joint and its bus.

    Attributes:
        family: "generic", "homing" (that one with homing) or "epos4".
        eds: data sheet or configuration file of the drive to be, instead of a family.
        node_id: 1 .. 127; None: what the file says, or 5.
        conduct: the drive's manners.
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
