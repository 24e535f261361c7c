"""`friction-bench simulate-device modbus`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import Baud, DeviceOptions, started


def simulate(
    map_: Annotated[str, typer.Option("--map", help="Register map: friction-bench or roboteq.")] = "friction-bench",
    transport: Annotated[str, typer.Option(help="rtu (a pseudo-terminal) or tcp.")] = "rtu",
    unit: Annotated[int, typer.Option(min=1, max=247, help="Unit number.")] = 1,
    low_word_first: Annotated[
        bool, typer.Option("--low-word-first", help="32-bit values: low word first (friction-bench only).")
    ] = False,
    baud: Baud = 115200,
    port: Annotated[int, typer.Option(min=0, max=65535, help="TCP port; 0 is any free one.")] = 0,
    *,
    options: DeviceOptions,
) -> Simulated:
    """A drive on Modbus RTU or TCP, by one of the register maps that come with the package."""
    from sim_backend.devices.modbus.serve import ModbusSettings, serve_modbus

    settings = ModbusSettings(
        map=map_, transport=transport, unit=unit, low_word_first=low_word_first, baud=baud or None, port=port,
        **options.values(),
    )  # fmt: skip
    device = started(lambda: serve_modbus(settings))
    drive: DriveTable = {"kind": "modbus", "map": map_, "transport": transport, "unit": unit}
    if transport == "tcp":
        host, number = device.path.split(":")
        drive |= {"host": host, "port": number}
    else:
        drive |= {"port": device.path, "baud_rate": baud or 115200}
    if map_ == "roboteq":  # its watchdog has no register
        drive |= {"watchdog_s": 1.0, "watchdog_is_set_in_drive": True}
    return Simulated(device, f"Modbus drive ({map_})", drive)
