"""The Feetech STS servo as a kind of drive."""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.scanning import FoundDrive, SerialPlace
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.feetech.settings import FeetechSettings
from drivers.follower import Follower

_BAUD_RATES = (1_000_000, 115200)
_IDS = range(254)


class FeetechDriveSettings(FeetechSettings, RealDriveSettings):
    """One Feetech STS servo. It has no watchdog."""

    kind: Literal["feetech"]


def make(settings: FeetechDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.feetech.drive import FeetechDrive

    return FeetechDrive(settings, joint_scale(settings, rig))


def follow(settings: FeetechDriveSettings, rig: Rig, link: Path, period_s: float) -> Follower:
    """Stand between another program and the servo."""
    from drivers.feetech.drive import follow as followed

    return followed(settings, joint_scale(settings, rig), link, period_s)


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask one id after the other, at each baud rate: where all are asked, all answer at once."""
    from drivers.feetech.frames import SCS
    from drivers.servos.bus import answering

    for baud_rate in place.baud_rates or _BAUD_RATES:
        for found in answering(place.port, baud_rate, SCS, _IDS):
            yield FoundDrive("Feetech servo; IT HAS NO WATCHDOG: it goes on where this host is silent", {
                "kind": "feetech", "port": place.port, "baud_rate": baud_rate, "servo_id": found.servo_id,
                "accept_no_watchdog": False,
            })  # fmt: skip


KIND = DriveKind(
    title="Feetech STS servo, SCS protocol",
    settings=FeetechDriveSettings,
    make=make,
    simulate=command_in("bench.drives.feetech.device"),
    scan_serial=scan,
    follow=follow,
    conformance=(
        ConformanceBench(
            "feetech",
            ("--baud", "0"),
            {"answer_timeout_s": 0.3},
            wrong_address=("servo_id", 99),
            knows_counts=True,
            has_watchdog=False,
        ),
    ),
)
