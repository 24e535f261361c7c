"""The moteus controller as a kind of drive."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from pydantic import model_validator

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, driver_values, joint_scale
from bench.config.drives.scanning import CanPlace, FoundDrive, SerialPlace
from bench.config.drives.simulated_device import Simulate
from bench.config.quantities import quantity
from bench.config.rig import Rig
from bench.errors import ConfigurationError
from drivers.contract import Drive
from drivers.follower import Follower

if TYPE_CHECKING:
    from drivers.can_bus.settings import BusSettings
    from drivers.moteus.opening import Line

Options = dict[str, str | int | float | bool]
_IDS = range(1, 127)
_ANSWER_S = 0.2
_ASK_MODE = bytes((0x11, 0x00))  # read one register, the mode, as int8


class MoteusDriveSettings(RealDriveSettings):
    """One moteus controller, by its registers: torque."""

    kind: Literal["moteus"]
    port: str = quantity("", "", "Serial port of the fdcanusb, or of its UART; left out with a CAN-FD bus")
    interface: str = quantity("", "", "Interface of python-can for a CAN-FD bus, in the place of a port")
    channel: str = quantity("", "", "Of the interface: can0, PCAN_USBBUS1")
    options: Options = quantity(
        {}, "", "What else the interface takes, as python-can's documentation of it says: bit rates of CAN-FD"
    )
    servo_id: int = quantity(1, "", "Id of the controller", ge=1, le=126)
    over_uart: bool = quantity(False, "", "true: the port is the controller's own UART, whose lines have checksums")
    watchdog_s: float = quantity(0.2, "s", "Silence after which it stops; goes out with every torque", ge=0.01, le=2)
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for the answers of a cycle", ge=0.002, le=1.0)

    @model_validator(mode="after")
    def _check_place(self) -> "MoteusDriveSettings":
        if bool(self.port) == bool(self.interface and self.channel):
            raise ValueError("either port, or interface and channel are wanted")
        return self


def make(settings: MoteusDriveSettings, rig: Rig) -> Drive:
    """The driver."""
    from drivers.moteus.drive import MoteusDrive
    from drivers.moteus.settings import MoteusSettings

    values = driver_values(settings)
    place = [values.pop(name) for name in ("interface", "channel", "options")]
    bus = _bus(*place) if settings.interface else None
    return MoteusDrive(MoteusSettings(bus=bus, **values), joint_scale(settings, rig))


def follow(settings: MoteusDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another host drives on the same bus.

    Raises:
        ConfigurationError: it is on a serial port, which is the other program's.
    """
    from drivers.moteus.drive import follow

    if not settings.interface:
        raise ConfigurationError(
            f"drive.port is '{settings.port}': an adapter is one program's alone, and nothing is heard beside it. Give "
            "drive.interface and drive.channel of a CAN-FD bus that is shared (socketcan)"
        )
    bus = _bus(settings.interface, settings.channel, settings.options)
    return follow(bus, settings.servo_id, joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.moteus.device import simulate

    return simulate


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
    for servo_id in _found(MoteusCanLine(_bus(place.interface, place.channel, {}), 0.01)):
        yield FoundDrive("moteus controller", {
            "kind": "moteus", "interface": place.interface, "channel": place.channel, "servo_id": servo_id,
        })  # fmt: skip


def _found(line: "Line") -> list[int]:
    """The ids that answer; the line is closed then."""
    try:
        return sorted(dict(line.listen(dict.fromkeys(_IDS, _ASK_MODE), _ANSWER_S)))
    finally:
        line.close()


def _bus(interface: str, channel: str, options: Options) -> "BusSettings":
    from drivers.can_bus.settings import BusSettings

    fd: Options = {"fd": True} if interface == "socketcan" else {}  # others have more to say, or nothing
    return BusSettings(interface, channel, options=fd | options)


_PATIENT = {"watchdog_s": 1.0, "answer_timeout_s": 0.3}

KIND = DriveKind(
    title="moteus controller, its registers over CAN-FD",
    settings=MoteusDriveSettings,
    make=make,
    simulate=simulate,
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
