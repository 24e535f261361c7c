"""The Feetech STS servo as a kind of drive."""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, driver_values, joint_scale
from bench.config.drives.scanning import FoundDrive, SerialPlace
from bench.config.drives.simulated_device import Simulate
from bench.config.quantities import quantity
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.follower import Follower

_BAUD_RATES = (1_000_000, 115200)
_IDS = range(254)

BaudRate = Literal[38400, 57600, 76800, 115200, 128_000, 250_000, 500_000, 1_000_000]


class FeetechDriveSettings(RealDriveSettings):
    """One Feetech STS servo. It has no watchdog."""

    kind: Literal["feetech"]
    port: str = quantity(..., "", "Serial port, such as /dev/ttyACM0", min_length=1)
    baud_rate: BaudRate = quantity(1_000_000, "", "Baud rate of the line")
    servo_id: int = quantity(1, "", "Id of the servo", ge=0, le=253)
    accept_no_watchdog: bool = quantity(
        False, "", "true: it is known that the motor goes on with the last demand where this computer falls silent"
    )
    torque_limit: float = quantity(1.0, "", "Highest share of its torque, set in the servo", gt=0, le=1)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)


def make(settings: FeetechDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.feetech.drive import FeetechDrive
    from drivers.feetech.settings import FeetechSettings

    return FeetechDrive(FeetechSettings(**driver_values(settings)), joint_scale(settings, rig))


def follow(settings: FeetechDriveSettings, rig: Rig, link: Path, period_s: float) -> Follower:
    """Stand between another program and the servo."""
    from drivers.feetech.drive import follow as followed
    from drivers.feetech.settings import FeetechSettings

    return followed(FeetechSettings(**driver_values(settings)), joint_scale(settings, rig), link, period_s)


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.feetech.device import simulate

    return simulate


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
    simulate=simulate,
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
