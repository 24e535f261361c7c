"""The Dynamixel as a kind of drive."""

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import driver_values, joint_scale
from bench.config.drives.scanning import SerialScan
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from bench.drives.dynamixel.settings import DynamixelDriveSettings
from drivers.contract import Drive


def make(settings: DynamixelDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.dynamixel.drive import DynamixelDrive
    from drivers.dynamixel.settings import DynamixelSettings

    return DynamixelDrive(DynamixelSettings(**driver_values(settings)), joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.dynamixel.device import simulate

    return simulate


def scan() -> SerialScan:
    """What says which ones answer."""
    from bench.drives.dynamixel.scan import scan

    return scan


KIND = DriveKind(
    title="Dynamixel X servo, protocol 2.0",
    settings=DynamixelDriveSettings,
    make=make,
    simulate=simulate,
    scan_serial=scan,
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
