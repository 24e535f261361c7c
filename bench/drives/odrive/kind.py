"""The ODrive as a kind of drive."""

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.scanning import CanPlace, FoundDrive
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.follower import Follower
from drivers.odrive.settings import OdriveSettings

_LISTEN_S = 0.3  # a heartbeat comes every 0.1 s


class OdriveDriveSettings(OdriveSettings, RealDriveSettings):
    """One axis of an ODrive, over CANSimple: torque."""

    kind: Literal["odrive"]


def make(settings: OdriveDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.odrive.drive import OdriveDrive

    return OdriveDrive(settings, joint_scale(settings, rig))


def follow(settings: OdriveDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives: to every answer, on the same bus."""
    from drivers.odrive.drive import follow

    return follow(settings, joint_scale(settings, rig))


def scan(place: CanPlace) -> Iterator[FoundDrive]:
    """Listen for heartbeats; nothing is sent. A node whose heartbeat is as long and as seldom looks the same."""
    from drivers.can_bus.port import CanPort
    from drivers.can_bus.settings import BusSettings
    from drivers.odrive.protocol import HEARTBEAT, Command

    with closing(CanPort(BusSettings(place.interface, place.channel, place.bitrate))) as port:
        port.wait_for([-1], _LISTEN_S)  # which never comes
        for identifier in port.heard_ids():
            heard = port.last(identifier)
            is_heartbeat = identifier & 31 == Command.HEARTBEAT and heard is not None
            if is_heartbeat and heard is not None and len(heard.data) >= HEARTBEAT.size:
                yield FoundDrive(f"ODrive axis, in state {HEARTBEAT.unpack_from(heard.data)[1]}", {
                    "kind": "odrive", "interface": place.interface, "channel": place.channel,
                    "bitrate": place.bitrate, "node_id": identifier >> 5, "watchdog_is_set_in_drive": False,
                })  # fmt: skip


KIND = DriveKind(
    title="ODrive axis, CANSimple",
    settings=OdriveDriveSettings,
    make=make,
    simulate=command_in("bench.drives.odrive.device"),
    follow=follow,
    scan_can=scan,
    conformance=(
        ConformanceBench(
            "odrive",
            ("--watchdog", "1.0"),
            {"answer_timeout_s": 0.3},
            wrong_address=("node_id", 33),
            is_checked=False,  # the serial leg of a CAN adapter (slcan)
            knows_counts=None,
        ),
    ),
)
