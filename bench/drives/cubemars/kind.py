"""The CubeMars actuator as a kind of drive. It cannot be looked for: each frame that it answers is a command."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import CanDriveSettings, can_values, joint_scale
from bench.config.drives.simulated_device import Simulate
from bench.config.quantities import quantity
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.follower import Follower

if TYPE_CHECKING:
    from sim_backend.devices.mit.serve import Make

Model = Literal[
    "", "AK10-9", "AK40-10", "AK45-10", "AK45-36", "AK60-6", "AK70-10", "AK80-6", "AK80-8", "AK80-9", "AK80-64"
]


class CubemarsDriveSettings(CanDriveSettings):
    """One CubeMars actuator, over the MIT protocol: torque. It has no watchdog."""

    kind: Literal["cubemars"]
    motor_id: int = quantity(1, "", "CAN id of the actuator", ge=1, le=0x7F)
    feedback_id: int | None = quantity(
        None, "", "Identifier of its answers; left out: motor_id; 0 with older firmware", ge=0, le=0x7FF
    )
    model: Model = quantity("", "", "Model on its plate, whose ranges its frames have")
    position_range_rad: float = quantity(
        0.0, "rad", "Range of another firmware, with the next two; 0: the model's", ge=0
    )
    speed_range_rad_s: float = quantity(0.0, "rad/s", "Range of another firmware; 0: the model's", ge=0)
    torque_range_n_m: float = quantity(0.0, "N m", "Range of another firmware; 0: the model's", ge=0)
    accept_no_watchdog: bool = quantity(
        False, "", "true: it is known that the motor goes on with the last torque where this computer falls silent"
    )
    is_simulated: bool = quantity(False, "", "true of a simulated device: its frames have no place for that")
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)


def make(settings: CubemarsDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.cubemars.drive import CubemarsDrive
    from drivers.cubemars.settings import CubemarsSettings

    return CubemarsDrive(CubemarsSettings(**can_values(settings)), joint_scale(settings, rig))


def follow(settings: CubemarsDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives: to every answer, on the same bus."""
    from drivers.cubemars.drive import follow
    from drivers.cubemars.settings import CubemarsSettings

    return follow(CubemarsSettings(**can_values(settings)), joint_scale(settings, rig))


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
