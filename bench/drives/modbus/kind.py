"""Drives on Modbus as a kind."""

from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, driver_values, joint_scale
from bench.config.drives.simulated_device import Simulate
from bench.config.quantities import quantity
from bench.config.rig import Rig
from bench.errors import ConfigurationError
from drivers.contract import Drive, Mode

_UNHURRIED = {"watchdog_s": 1.0, "answer_timeout_s": 0.3}


class ModbusDriveSettings(RealDriveSettings):
    """A drive on Modbus RTU or TCP, by its register map."""

    kind: Literal["modbus"]
    map: str = quantity(..., "", "Register map: a name that comes with the package, or a .toml file", min_length=1)
    transport: Literal["rtu", "tcp"] = quantity("rtu", "", "'rtu': serial line; 'tcp': network")
    port: str = quantity(..., "", "Serial port, such as /dev/ttyUSB0; or the TCP port", min_length=1)
    host: str = quantity("127.0.0.1", "", "Name or address of the drive; 'tcp' only")
    unit: int = quantity(1, "", "Address of the drive on the line", ge=0, le=247)
    baud_rate: int = quantity(115200, "", "Baud rate of the line", ge=1200, le=4_000_000)
    parity: Literal["N", "E", "O"] = quantity("N", "", "Parity of the line")
    stop_bits: Literal[1, 2] = quantity(1, "", "Stop bits of the line")
    watchdog_s: float = quantity(0.2, "s", "Silence after which the drive stops by itself", gt=0, le=2.0)
    watchdog_is_set_in_drive: bool = quantity(
        False, "", "True where the map has no watchdog register, and it was set and tried with the drive's own tools"
    )
    answer_timeout_s: float = quantity(0.05, "s", "Longest wait for one answer", ge=0.005, le=1.0)
    slow_every: int = quantity(
        10,
        "cycles",
        "Cycles between requests for what changes slowly, where it takes requests of its own",
        ge=1,
        le=100,
    )
    silence_s: float | None = quantity(
        None,
        "s",
        "Rest of the line between an answer and the next request; left out: 3.5 characters",
        ge=0,
        le=0.1,
    )
    echo: bool = quantity(False, "", "True where the serial adapter hears what it sends itself (two-wire RS-485)")
    current_limit_a: float | None = quantity(
        None, "A", "Highest motor current, set in the drive by the map's [limits]; left out: the drive's own", gt=0
    )


def make(settings: ModbusDriveSettings, rig: Rig) -> Drive:
    """The driver with its register map.

    Raises:
        ConfigurationError: there is no such map, it cannot be used, or the TCP port is no number.
    """
    from drivers.modbus.drive import ModbusDrive
    from drivers.modbus.map_file import MapError, load_map
    from drivers.modbus.settings import ModbusSettings

    if settings.transport == "tcp" and not settings.port.isdigit():
        raise ConfigurationError(f"drive.port is '{settings.port}'; with drive.transport = 'tcp' a number is wanted")
    try:
        register_map = load_map(settings.map)
    except MapError as error:
        raise ConfigurationError(f"drive.map: {error}") from error
    return ModbusDrive(ModbusSettings(**driver_values(settings)), register_map, joint_scale(settings, rig))


def simulate() -> Simulate:
    """The command that simulates one."""
    from bench.drives.modbus.device import simulate

    return simulate


KIND = DriveKind(
    title="drive on Modbus RTU or TCP, by its register map",
    settings=ModbusDriveSettings,
    make=make,
    simulate=simulate,
    conformance=(
        ConformanceBench(
            "modbus-rtu",
            ("--transport", "rtu", "--baud", "0"),
            _UNHURRIED,
            wrong_address=("unit", 9),
            refused_mode=Mode.DUTY,
        ),
        ConformanceBench(
            "modbus-tcp",
            ("--transport", "tcp"),
            _UNHURRIED,
            has_link=False,
            wrong_address=("unit", 9),
            refused_mode=Mode.DUTY,
            is_checked=None,
        ),
    ),
)
