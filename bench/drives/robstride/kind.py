"""The RobStride actuator as a kind of drive."""

from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.scanning import CanPlace, FoundDrive
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.follower import Follower
from drivers.robstride.settings import RobstrideSettings

if TYPE_CHECKING:
    from sim_backend.devices.mit.serve import Make

_IDS = range(1, 128)
_ANSWER_S = 0.3


class RobstrideDriveSettings(RobstrideSettings, RealDriveSettings):
    """One RobStride actuator, over its own protocol: torque."""

    kind: Literal["robstride"]


def make(settings: RobstrideDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.robstride.drive import RobstrideDrive

    return RobstrideDrive(settings, joint_scale(settings, rig))


def follow(settings: RobstrideDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives: to every answer, on the same bus."""
    from drivers.robstride.drive import follow

    return follow(settings, joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.mit_device import simulates

    summary = "A RobStride actuator (its own protocol) on a CAN bus; its ranges fit the joint of the paper."
    return simulates("robstride", "RobStride, its own protocol", summary, 127, _maker, {})


def _maker() -> "Make":
    from sim_backend.devices.robstride.motor import RobstrideMotor

    return RobstrideMotor


def scan(place: CanPlace) -> Iterator[FoundDrive]:
    """Ask each id who it is, which moves nothing."""
    from drivers.can_bus.port import CanPort
    from drivers.can_bus.settings import BusSettings
    from drivers.robstride import protocol

    with closing(CanPort(BusSettings(place.interface, place.channel, place.bitrate))) as port:
        for motor_id in _IDS:
            port.send(*protocol.frame(protocol.Kind.IDENTIFY, motor_id))
            port.drain()
        port.wait_for([-1], _ANSWER_S)  # which never comes
        for motor_id in _IDS:
            heard = port.last(protocol.identity_id(motor_id))
            if heard is not None:
                yield FoundDrive(f"RobStride actuator {heard.data.hex(' ', 2)}; add the model on its plate", {
                    "kind": "robstride", "interface": place.interface, "channel": place.channel,
                    "bitrate": place.bitrate, "motor_id": motor_id,
                })  # fmt: skip


KIND = DriveKind(
    title="RobStride actuator, its own protocol",
    settings=RobstrideDriveSettings,
    make=make,
    simulate=simulate,
    follow=follow,
    scan_can=scan,
    conformance=(
        ConformanceBench(
            "robstride",
            ("--position-range", "50.265"),  # 16 bits of it are steps of 1/4096 turn
            {"watchdog_s": 1.0, "answer_timeout_s": 0.3},
            wrong_address=("motor_id", 33),
            is_checked=False,  # the serial leg of a CAN adapter (slcan)
            knows_counts=None,
        ),
    ),
)
