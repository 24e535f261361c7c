"""The RoboClaw as a kind of drive."""

from collections.abc import Iterator
from typing import Literal, get_args

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, driver_values, joint_scale
from bench.config.drives.scanning import FoundDrive, SerialPlace
from bench.config.drives.simulated_device import Simulate
from bench.config.quantities import quantity
from bench.config.rig import Rig
from drivers.contract import Drive

BAUD_RATE, ADDRESSES = 115200, range(0x80, 0x88)
SCAN_S = 0.15  # that is waited for an answer, asked twice: a busy host may be away for 50 ms

BaudRate = Literal[2400, 9600, 19200, 38400, 57600, 115200, 230400, 460800]


class RoboclawDriveSettings(RealDriveSettings):
    """One motor of a RoboClaw, over packet serial."""

    kind: Literal["roboclaw"]
    port: str = quantity(..., "", "Serial port, such as /dev/ttyACM0", min_length=1)
    baud_rate: BaudRate = quantity(115200, "", "Baud rate of the line; ignored on USB")
    address: int = quantity(0x80, "", "Address of the controller", ge=0x80, le=0x87)
    motor: Literal[1, 2] = quantity(1, "", "Which of its two motors")
    watchdog_s: float = quantity(0.2, "s", "Silence after which it stops the motor, in steps of 0.1 s", ge=0.1, le=2.0)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.005, le=1.0)
    slow_every: int = quantity(
        4, "cycles", "Cycles between questions for status, supply voltage or temperature, in turn", ge=1, le=100
    )
    velocity: Literal["drive", "none"] = quantity(
        "drive",
        "",
        "'drive': its own, filtered speed (command 18); 'none': derived from the position, one question less",
    )
    current: Literal["signed", "magnitude"] = quantity(
        "signed", "", "'magnitude' where it reports the current without the sign of the torque"
    )
    questions: Literal["auto", "in turn", "together"] = quantity(
        "auto",
        "",
        "'together': a cycle's duty and questions in one write, which is quicker; 'auto': together where it answers "
        "them all when it is opened, otherwise in turn",
    )
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the controller; left out: the controller's own", gt=0, le=1000
    )


def make(settings: RoboclawDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.roboclaw.drive import RoboclawDrive
    from drivers.roboclaw.settings import RoboclawSettings

    return RoboclawDrive(RoboclawSettings(**driver_values(settings)), joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.roboclaw.device import simulate

    return simulate


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask for the version at each address, until one answers; over USB every address is its own."""
    from drivers.errors import DriveConnectionError
    from drivers.roboclaw.link import Link
    from drivers.roboclaw.settings import RoboclawSettings

    for baud_rate in set(place.baud_rates or (BAUD_RATE,)) & set(get_args(BaudRate)):
        for address in ADDRESSES:
            settings = RoboclawSettings(port=place.port, baud_rate=baud_rate, address=address, answer_timeout_s=SCAN_S)
            link = Link(settings, f"{place.port} address {address:#x}")
            try:
                link.begin()
                version = link.version()
            except DriveConnectionError:
                continue
            finally:
                link.close()
            yield FoundDrive(
                version.strip(),
                {"kind": "roboclaw", "port": place.port, "baud_rate": baud_rate, "address": address},
            )
            return


KIND = DriveKind(
    title="RoboClaw motor controller, packet serial",
    settings=RoboclawDriveSettings,
    make=make,
    simulate=simulate,
    scan_serial=scan,
    conformance=(
        ConformanceBench(
            "roboclaw", ("--baud", "0"), {"watchdog_s": 1.0, "answer_timeout_s": 0.3}, wrong_address=("address", 0x83)
        ),
    ),
)
