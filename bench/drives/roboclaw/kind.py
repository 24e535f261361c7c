"""The RoboClaw as a kind of drive."""

from collections.abc import Iterator
from typing import Literal, get_args

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.scanning import FoundDrive, SerialPlace
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from drivers.contract import Drive
from drivers.roboclaw.settings import BaudRate, RoboclawSettings

BAUD_RATE, ADDRESSES = 115200, range(0x80, 0x88)
SCAN_S = 0.15  # that is waited for an answer, asked twice: a busy host may be away for 50 ms


class RoboclawDriveSettings(RoboclawSettings, RealDriveSettings):
    """One motor of a RoboClaw, over packet serial."""

    kind: Literal["roboclaw"]


def make(settings: RoboclawDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.roboclaw.drive import RoboclawDrive

    return RoboclawDrive(settings, joint_scale(settings, rig))


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask for the version at each address, until one answers; over USB every address is its own."""
    from drivers.errors import DriveConnectionError
    from drivers.roboclaw.link import Link

    for baud_rate in [one for one in get_args(BaudRate) if one in (place.baud_rates or (BAUD_RATE,))]:
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
    simulate=command_in("bench.drives.roboclaw.device"),
    scan_serial=scan,
    conformance=(
        ConformanceBench(
            "roboclaw", ("--baud", "0"), {"watchdog_s": 1.0, "answer_timeout_s": 0.3}, wrong_address=("address", 0x83)
        ),
    ),
)
