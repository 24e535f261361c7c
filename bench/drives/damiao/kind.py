"""The Damiao actuator as a kind of drive."""

from bench.config.drives.can_bus import can_values
from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import joint_scale
from bench.config.drives.scanning import CanScan
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from bench.drives.damiao.settings import DamiaoDriveSettings
from drivers.contract import Drive


def make(settings: DamiaoDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.damiao.drive import DamiaoDrive
    from drivers.damiao.settings import DamiaoSettings

    return DamiaoDrive(DamiaoSettings(**can_values(settings)), joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.damiao.device import simulate

    return simulate


def scan() -> CanScan:
    """What says which ones answer."""
    from bench.drives.damiao.scan import scan

    return scan


KIND = DriveKind(
    title="Damiao actuator, MIT protocol",
    settings=DamiaoDriveSettings,
    make=make,
    simulate=simulate,
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
