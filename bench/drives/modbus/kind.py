"""Drives on Modbus as a kind."""

from typing import Literal

from bench.config.drives.kind import ConformanceBench, DriveKind
from bench.config.drives.real import RealDriveSettings, joint_scale
from bench.config.drives.simulated_device import command_in
from bench.config.rig import Rig
from bench.errors import ConfigurationError
from drivers.contract import Drive, Mode
from drivers.modbus.settings import ModbusSettings

_UNHURRIED = {"watchdog_s": 1.0, "answer_timeout_s": 0.3}


class ModbusDriveSettings(ModbusSettings, RealDriveSettings):
    """A drive on Modbus RTU or TCP, by its register map."""

    kind: Literal["modbus"]


def make(settings: ModbusDriveSettings, rig: Rig) -> Drive:
    """The driver with its register map.

    Raises:
        ConfigurationError: there is no such map, it cannot be used, or the TCP port is no number.
    """
    from drivers.modbus.drive import ModbusDrive
    from drivers.modbus.map_file import MapError, load_map

    if settings.transport == "tcp" and not settings.port.isdigit():
        raise ConfigurationError(f"drive.port is '{settings.port}'; with drive.transport = 'tcp' a number is wanted")
    try:
        register_map = load_map(settings.map)
    except MapError as error:
        raise ConfigurationError(f"drive.map: {error}") from error
    return ModbusDrive(settings, register_map, joint_scale(settings, rig))


KIND = DriveKind(
    title="drive on Modbus RTU or TCP, by its register map",
    settings=ModbusDriveSettings,
    make=make,
    simulate=command_in("bench.drives.modbus.device"),
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
