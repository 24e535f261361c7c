"""The RoboClaw as a kind of drive."""

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import driver_values, joint_scale
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from bench.drives.roboclaw.settings import RoboclawDriveSettings
from drivers.contract import Drive


def make(settings: RoboclawDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.roboclaw.drive import RoboclawDrive
    from drivers.roboclaw.settings import RoboclawSettings

    return RoboclawDrive(RoboclawSettings(**driver_values(settings)), joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.roboclaw.device import simulate

    return simulate


KIND = DriveKind(
    title="RoboClaw motor controller, packet serial",
    settings=RoboclawDriveSettings,
    make=make,
    simulate=simulate,
    conformance=(
        ConformanceBench(
            "roboclaw", ("--baud", "0"), {"watchdog_s": 1.0, "answer_timeout_s": 0.3}, wrong_address=("address", 0x83)
        ),
    ),
)
