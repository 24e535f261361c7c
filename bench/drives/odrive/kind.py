"""The ODrive as a kind of drive."""

from bench.config.drives.can_bus import can_values
from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import joint_scale
from bench.config.drives.scanning import CanScan
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from bench.drives.odrive.settings import OdriveDriveSettings
from drivers.contract import Drive


def make(settings: OdriveDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.odrive.drive import OdriveDrive
    from drivers.odrive.settings import OdriveSettings

    return OdriveDrive(OdriveSettings(**can_values(settings)), joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.odrive.device import simulate

    return simulate


def scan() -> CanScan:
    """What says which ones answer."""
    from bench.drives.odrive.scan import scan

    return scan


KIND = DriveKind(
    title="ODrive axis, CANSimple",
    settings=OdriveDriveSettings,
    make=make,
    simulate=simulate,
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
