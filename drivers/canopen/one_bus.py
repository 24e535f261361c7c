"""Several drives of one bench on one bus: it is opened once, and has one SYNC in each cycle."""

from collections.abc import Sequence

from drivers.canopen.drive import CanopenDrive
from drivers.errors import DriveConfigurationError


def share_buses(drives: Sequence[CanopenDrive]) -> None:
    """Let drives that are on one bus use it together. None is open yet, and one thread uses all of them.

    Raises:
        DriveConfigurationError: two have one node ID, or their settings of the bus differ.
    """
    for place, drive in enumerate(drives):
        for earlier in drives[:place]:
            if earlier.settings.bus.place == drive.settings.bus.place:
                _check(drive, earlier)
                drive.port = earlier.port


def _check(drive: CanopenDrive, other: CanopenDrive) -> None:
    ours, theirs = drive.settings, other.settings
    if ours.node_id == theirs.node_id:
        raise DriveConfigurationError(
            ours.device, "is the drive of two joints of this bench; give each joint the node_id of a drive of its own"
        )
    if ours.bus != theirs.bus:
        raise DriveConfigurationError(
            ours.device,
            f"is on one bus with node {theirs.node_id}, and their settings of it differ: {ours.bus!r}, {theirs.bus!r}. "
            "Make bitrate and the other settings of the bus the same",
        )
