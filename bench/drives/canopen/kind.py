"""CiA 402 drives on a CAN bus as a kind."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import joint_scale
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from bench.errors import ConfigurationError
from drivers.canopen.parameters import CanopenParameters
from drivers.contract import Drive
from drivers.follower import Follower

if TYPE_CHECKING:  # imported when needed: a bench needs no library of another kind
    from drivers.canopen.drive import CanopenDrive
    from drivers.canopen.settings import CanopenSettings
from typing import Literal

from bench.config.drives.real import RealDriveSettings
from bench.config.quantities import quantity
from bench.config.rig import Section
from drivers.can_bus.settings import Bitrate, Options

_UNHURRIED = {"watchdog_s": 1.0, "answer_s": 0.6}


class CanopenBus(Section):
    """How the bus is reached."""

    interface: str = quantity(
        ...,
        "",
        "How the bus is reached, by python-can's name: socketcan (Linux network interface), slcan (serial adapter), "
        "socketcand (TCP server), pcan, kvaser, gs_usb, udp_multicast ..., virtual (inside one process)",
        min_length=1,
    )
    channel: str = quantity(..., "", "can0, /dev/ttyACM0, PCAN_USBBUS1, or the bus's name at the server", min_length=1)
    bitrate: Bitrate = quantity(1_000_000, "bit/s", "Bit rate of the bus")
    host: str = quantity("localhost", "", "Host of the socketcand server")
    port: int = quantity(29536, "", "Port of the socketcand server", ge=1, le=65535)
    tty_baudrate: int = quantity(
        115200, "bit/s", "Baud rate of the serial line of an slcan adapter; ignored on USB", ge=9600
    )
    adapter_start_s: float = quantity(0.0, "s", "What an slcan adapter needs after its port is opened", ge=0, le=10)
    options: Options = quantity({}, "", "What else the interface takes, as python-can's documentation of it says")


class CanopenDriveSettings(CanopenParameters, CanopenBus, RealDriveSettings):
    """One drive on a CAN bus, over CANopen with the CiA 402 profile."""

    kind: Literal["canopen"]
    tpdo_mapping: dict[str, list[int]] = quantity(
        {},
        "",
        "For `record`: entries of the TPDOs that another master has set up (0x60640020), by COB-ID ('0x185')",
    )


def make(settings: CanopenDriveSettings, rig: Rig) -> Drive:
    """The driver.

    Raises:
        ConfigurationError: settings that contradict each other.
    """
    from drivers.canopen.drive import CanopenDrive

    with _refusals():
        return CanopenDrive(_driver_settings(settings, rig), joint_scale(settings, rig))


def follow(settings: CanopenDriveSettings, rig: Rig, _link: Path, _period_s: float) -> Follower:
    """What listens to one that another master drives.

    Raises:
        ConfigurationError: settings that contradict each other, a mapping without the position, or a COB-ID that is no
            number.
    """
    from drivers.canopen.follow import follow

    try:
        mappings = {int(cob_id, 0): entries for cob_id, entries in settings.tpdo_mapping.items()}
    except ValueError as error:
        raise ConfigurationError(f"drive.tpdo_mapping: {error}; a COB-ID such as '0x185' is wanted") from error
    with _refusals():
        return follow(_driver_settings(settings, rig), joint_scale(settings, rig), mappings)


@contextmanager
def _refusals() -> Iterator[None]:
    """Settings that the driver refuses are wrong in the configuration."""
    from drivers.errors import DriveConfigurationError

    try:
        yield
    except DriveConfigurationError as error:
        raise ConfigurationError(str(error)) from error


def _driver_settings(settings: CanopenDriveSettings, rig: Rig) -> "CanopenSettings":
    from drivers.can_bus.settings import BusSettings
    from drivers.canopen.cia402.bits import BrakeBit
    from drivers.canopen.cia402.homing import DriveHoming
    from drivers.canopen.settings import CanopenSettings

    values = settings.model_dump(include=set(CanopenParameters.model_fields))
    if settings.brake.by == "output":
        values["brake"] = BrakeBit(settings.brake.output_bit, settings.brake.set_level)
    homing = settings.homing
    if homing is not None and homing.method == "drive" and homing.drive_method is not None:
        values["homing"] = DriveHoming(
            homing.drive_method, homing.speed_rad_s, homing.slow_speed_rad_s, homing.acceleration_rad_s2
        )
    bus = BusSettings(**settings.model_dump(include=set(CanopenBus.model_fields)))
    return CanopenSettings(bus=bus, torque_constant_n_m_a=rig.motor.torque_constant_n_m_a, **values)


def share(drives: "Sequence[CanopenDrive]") -> None:
    """One bus for the drives that are on one.

    Raises:
        ConfigurationError: two have one node ID, or their settings of the bus differ.
    """
    from drivers.canopen.one_bus import share_buses

    with _refusals():
        share_buses(drives)


KIND = DriveKind(
    title="CiA 402 servo drive, CANopen",
    settings=CanopenDriveSettings,
    make=make,
    simulate=command_in("bench.drives.canopen.device"),
    follow=follow,
    share=share,
    conformance=(
        ConformanceBench(
            "canopen",
            settings=_UNHURRIED,
            wrong_address=("node_id", 77),
            is_checked=False,  # the serial leg of a CAN adapter (slcan)
            knows_counts=True,
        ),
        ConformanceBench(
            "canopen-socketcand",
            ("--interface", "socketcand"),
            _UNHURRIED,
            has_link=False,
            wrong_address=("node_id", 77),
            is_checked=False,
            knows_counts=True,
        ),
    ),
)
