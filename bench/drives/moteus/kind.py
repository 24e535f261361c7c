"""The moteus controller as a kind of drive."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.scanning import CanPlace, FoundDrive, SerialPlace
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from bench.errors import ConfigurationError
from drivers.contract import Drive
from drivers.follower import Follower
from drivers.moteus.settings import MoteusSettings, fd_bus

if TYPE_CHECKING:
    from drivers.moteus.opening import Line

_IDS = range(1, 127)
_ANSWER_S = 0.2
_ASK_MODE = bytes((0x11, 0x00))  # read one register, the mode, as int8


class MoteusDriveSettings(MoteusSettings, RealDriveSettings):
    """One moteus controller, by its registers: torque."""

    kind: Literal["moteus"]


def make(settings: MoteusDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.moteus.drive import MoteusDrive

    return MoteusDrive(settings, joint_scale(settings, rig))


def follow(settings: MoteusDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives on the same bus.

    Raises:
        ConfigurationError: it is on a serial port, which is the other program's.
    """
    from drivers.moteus.drive import follow

    if settings.bus is None:
        raise ConfigurationError(
            f"drive.port is '{settings.port}': an adapter is one program's alone, and nothing is heard beside it. Give "
            "drive.interface and drive.channel of a CAN-FD bus that is shared (socketcan)"
        )
    return follow(settings.bus, settings.servo_id, joint_scale(settings, rig))


def scan(place: SerialPlace) -> Iterator[FoundDrive]:
    """Ask each id for its mode, which moves nothing; with checksums, and without."""
    from drivers.moteus.line import MoteusLine

    for over_uart in (False, True):
        found = _found(MoteusLine(place.port, over_uart, 0.01))
        for servo_id in found:
            yield FoundDrive("moteus controller", {
                "kind": "moteus", "port": place.port, "servo_id": servo_id, "over_uart": over_uart,
            })  # fmt: skip
        if found:
            return


def scan_can(place: CanPlace) -> Iterator[FoundDrive]:
    """The same on a CAN-FD bus, and on no other: its frames are errors to nodes that do not know them."""
    from drivers.moteus.can_line import MoteusCanLine

    if not place.is_fd:
        return
    for servo_id in _found(MoteusCanLine(fd_bus(place.interface, place.channel, {}), 0.01)):
        yield FoundDrive("moteus controller", {
            "kind": "moteus", "interface": place.interface, "channel": place.channel, "servo_id": servo_id,
        })  # fmt: skip


def _found(line: "Line") -> list[int]:
    """The ids that answer; the line is closed then."""
    try:
        return sorted(dict(line.listen(dict.fromkeys(_IDS, _ASK_MODE), _ANSWER_S)))
    finally:
        line.close()


_PATIENT = {"watchdog_s": 1.0, "answer_timeout_s": 0.3}

KIND = DriveKind(
    title="moteus controller, its registers over CAN-FD",
    settings=MoteusDriveSettings,
    make=make,
    simulate=command_in("bench.drives.moteus.device"),
    follow=follow,
    scan_serial=scan,
    scan_can=scan_can,
    conformance=(
        ConformanceBench(
            "moteus",
            (),
            _PATIENT,
            wrong_address=("servo_id", 33),
            is_checked=False,  # the serial leg of its adapter
            knows_counts=None,
        ),
        ConformanceBench("moteus-uart", ("--uart",), _PATIENT, wrong_address=("servo_id", 33), knows_counts=None),
    ),
)
