"""The Damiao actuator as a kind of drive."""

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
from drivers.damiao.settings import DamiaoSettings
from drivers.follower import Follower

_IDS = range(1, 33)
_ANSWER_S = 0.01


class DamiaoDriveSettings(DamiaoSettings, RealDriveSettings):
    """One Damiao actuator, over the MIT protocol: torque."""

    kind: Literal["damiao"]


def make(settings: DamiaoDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.damiao.drive import DamiaoDrive

    return DamiaoDrive(settings, joint_scale(settings, rig))


def follow(settings: DamiaoDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives: to every answer, on the same bus."""
    from drivers.damiao.drive import follow

    return follow(settings, joint_scale(settings, rig))


def scan(place: CanPlace) -> Iterator[FoundDrive]:
    """Ask each of the usual ids for its range of torques: the reading of a register."""
    from drivers.can_bus.port import CanPort
    from drivers.can_bus.settings import BusSettings
    from drivers.damiao import protocol

    with closing(CanPort(BusSettings(place.interface, place.channel, place.bitrate))) as port:
        for motor_id in _IDS:
            frame = protocol.register_frame(motor_id, protocol.READ, protocol.Register.TORQUE_RANGE)
            port.send(protocol.REGISTERS_ID, frame)
            port.wait_for([-1], _ANSWER_S)  # which never comes
            for identifier in port.heard_ids():
                heard = port.last(identifier)
                if heard and protocol.is_register(heard.data, motor_id, protocol.Register.TORQUE_RANGE):
                    torque_n_m = protocol.FLOAT.unpack(heard.data[4:])[0]
                    yield FoundDrive(f"Damiao actuator, range of torques {torque_n_m:g} N m", {
                        "kind": "damiao", "interface": place.interface, "channel": place.channel,
                        "bitrate": place.bitrate, "motor_id": motor_id, "feedback_id": identifier,
                    })  # fmt: skip


KIND = DriveKind(
    title="Damiao actuator, MIT protocol",
    settings=DamiaoDriveSettings,
    make=make,
    simulate=command_in("bench.drives.damiao.device"),
    follow=follow,
    scan_can=scan,
    conformance=(
        ConformanceBench(
            "damiao",
            ("--position-range", "50.265"),  # 16 bits of it are steps of 1/4096 turn
            {"watchdog_s": 1.0, "answer_timeout_s": 0.3},
            wrong_address=("motor_id", 33),
            is_checked=False,  # the serial leg of a CAN adapter (slcan)
            knows_counts=None,
        ),
    ),
)
