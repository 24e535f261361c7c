"""The Feetech STS servo as a kind of drive."""

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import driver_values, joint_scale
from bench.config.drives.scanning import SerialScan
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from bench.drives.feetech.settings import FeetechDriveSettings
from drivers.contract import Drive


def make(settings: FeetechDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.feetech.drive import FeetechDrive
    from drivers.feetech.settings import FeetechSettings

    return FeetechDrive(FeetechSettings(**driver_values(settings)), joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.feetech.device import simulate

    return simulate


def scan() -> SerialScan:
    """What says which ones answer."""
    from bench.drives.feetech.scan import scan

    return scan


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
