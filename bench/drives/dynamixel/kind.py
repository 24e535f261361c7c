"""The Dynamixel as a kind of drive."""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.scanning import FoundDrive, SerialPlace
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.dynamixel.settings import DynamixelSettings
from drivers.follower import Follower

_BAUD_RATES = (57600, 1_000_000, 2_000_000, 4_000_000, 115200)


class DynamixelDriveSettings(DynamixelSettings, RealDriveSettings):
    """One Dynamixel X servo, protocol 2.0."""

    kind: Literal["dynamixel"]


def make(settings: DynamixelDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.dynamixel.drive import DynamixelDrive

    return DynamixelDrive(settings, joint_scale(settings, rig))


def follow(settings: DynamixelDriveSettings, rig: Rig, link: Path, period_s: float) -> Follower:
    """Stand between another program and the servo."""
    from drivers.dynamixel.drive import follow as followed

    return followed(settings, joint_scale(settings, rig), link, period_s)


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask everybody, at each baud rate."""
    from drivers.dynamixel.frames import PROTOCOL_2
    from drivers.dynamixel.opening import MODELS
    from drivers.servos.bus import answering

    for baud_rate in place.baud_rates or _BAUD_RATES:
        for found in answering(place.port, baud_rate, PROTOCOL_2, None):
            number = int.from_bytes(found.data[:2], "little")
            name = MODELS[number].name if number in MODELS else f"model {number}, not one of the X series"
            yield FoundDrive(f"Dynamixel {name}, firmware {found.data[2]}", {
                "kind": "dynamixel", "port": place.port, "baud_rate": baud_rate, "servo_id": found.servo_id,
            })  # fmt: skip


KIND = DriveKind(
    title="Dynamixel X servo, protocol 2.0",
    settings=DynamixelDriveSettings,
    make=make,
    simulate=command_in("bench.drives.dynamixel.device"),
    scan_serial=scan,
    follow=follow,
    conformance=(
        ConformanceBench(
            "dynamixel",
            ("--baud", "0"),
            {"watchdog_s": 1.0, "answer_timeout_s": 0.3},
            wrong_address=("servo_id", 99),
            knows_counts=True,
        ),
    ),
)
