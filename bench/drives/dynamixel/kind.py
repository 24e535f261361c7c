"""The Dynamixel as a kind of drive."""

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

_BAUD_RATES = (57600, 1_000_000, 2_000_000, 4_000_000, 115200)

BaudRate = Literal[9600, 57600, 115200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000]


class DynamixelDriveSettings(RealDriveSettings):
    """One Dynamixel X servo, protocol 2.0."""

    kind: Literal["dynamixel"]
    port: str = quantity(..., "", "Serial port, such as /dev/ttyUSB0", min_length=1)
    baud_rate: BaudRate = quantity(57600, "", "Baud rate of the line")
    servo_id: int = quantity(1, "", "Id of the servo", ge=0, le=252)
    watchdog_s: float = quantity(
        0.2, "s", "Silence on the bus after which it stops the motor, in steps of 0.02 s", ge=0.02, le=2.0
    )
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.002, le=1.0)
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the servo; left out: the servo's own", gt=0, le=10
    )


def make(settings: DynamixelDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.dynamixel.drive import DynamixelDrive
    from drivers.dynamixel.settings import DynamixelSettings

    return DynamixelDrive(DynamixelSettings(**driver_values(settings)), joint_scale(settings, rig))


def follow(settings: DynamixelDriveSettings, rig: Rig, link: Path, period_s: float) -> Follower:
    """Stand between another program and the servo."""
    from drivers.dynamixel.drive import follow as followed
    from drivers.dynamixel.settings import DynamixelSettings

    return followed(DynamixelSettings(**driver_values(settings)), joint_scale(settings, rig), link, period_s)


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.dynamixel.device import simulate

    return simulate


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask everybody, at each baud rate."""
    from drivers.dynamixel.frames import PROTOCOL_2
    from drivers.dynamixel.models import MODELS
    from drivers.servos.bus import answering

    for baud_rate in place.baud_rates or _BAUD_RATES:
        for found in answering(place.port, baud_rate, PROTOCOL_2, None):
            number = int.from_bytes(found.data[:2], "little")
            name = MODELS[number].name if number in MODELS else f"model {number}, not one of the X series"
            yield FoundDrive(f"Dynamixel {name}, firmware {found.data[2]}", {
                "kind": "dynamixel", "port": place.port, "baud_rate": baud_rate, "servo_id": found.servo_id,
            })  # fmt: skip


KIND = DriveKind(
    title="Dynamixel X servo, protocol 2.0",
    settings=DynamixelDriveSettings,
    make=make,
    simulate=simulate,
    scan_serial=scan,
    follow=follow,
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
