"""The Feetech STS servo as a kind of drive."""

from collections.abc import Iterator

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import driver_values, joint_scale
from bench.config.drives.scanning import FoundDrive, SerialPlace
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from bench.drives.feetech.settings import FeetechDriveSettings
from drivers.contract import Drive

_BAUD_RATES = (1_000_000, 115200)
_IDS = range(254)


def make(settings: FeetechDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.feetech.drive import FeetechDrive
    from drivers.feetech.settings import FeetechSettings

    return FeetechDrive(FeetechSettings(**driver_values(settings)), joint_scale(settings, rig))


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
            yield FoundDrive("Feetech servo; IT HAS NO WATCHDOG, see the guide before you accept that", {
                "kind": "feetech", "port": place.port, "baud_rate": baud_rate, "servo_id": found.servo_id,
                "accept_no_watchdog": False,
            })  # fmt: skip


KIND = DriveKind(
    title="Feetech STS servo, SCS protocol",
    settings=FeetechDriveSettings,
    make=make,
    simulate=simulate,
    scan_serial=scan,
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
