"""The CubeMars actuator as a kind of drive. It cannot be looked for: each frame that it answers is a command."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.simulated_device import Simulate
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.cubemars.settings import CubemarsSettings
from drivers.follower import Follower

if TYPE_CHECKING:
    from sim_backend.devices.mit.serve import Make


class CubemarsDriveSettings(CubemarsSettings, RealDriveSettings):
    """One CubeMars actuator, over the MIT protocol: torque. It has no watchdog."""

    kind: Literal["cubemars"]


def make(settings: CubemarsDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.cubemars.drive import CubemarsDrive

    return CubemarsDrive(settings, joint_scale(settings, rig))


def follow(settings: CubemarsDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives: to every answer, on the same bus."""
    from drivers.cubemars.drive import follow

    return follow(settings, joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.mit_device import simulates

    summary = "A CubeMars actuator (MIT protocol) on a CAN bus; its ranges fit the joint of the paper."
    return simulates(
        "cubemars", "CubeMars, MIT protocol", summary, 1, _maker, {"accept_no_watchdog": True, "is_simulated": True}
    )


def _maker() -> "Make":
    from sim_backend.devices.cubemars.motor import CubemarsMotor

    return CubemarsMotor


KIND = DriveKind(
    title="CubeMars actuator, MIT protocol",
    settings=CubemarsDriveSettings,
    make=make,
    simulate=simulate,
    follow=follow,
    conformance=(
        ConformanceBench(
            "cubemars",
            ("--position-range", "50.265"),  # 16 bits of it are steps of 1/4096 turn
            {"answer_timeout_s": 0.3},
            wrong_address=("motor_id", 33),
            is_checked=False,  # the serial leg of a CAN adapter (slcan)
            knows_counts=None,
            has_watchdog=False,
            tells_firmware=False,
        ),
    ),
)
