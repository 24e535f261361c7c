"""`friction-bench simulate-device roboclaw`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import Baud, DeviceOptions, started


def simulate(
    address: Annotated[int, typer.Option(min=128, max=135, help="Address of the drive.")] = 128,
    usb: Annotated[bool, typer.Option("--usb", help="Answer to every address, as over USB.")] = False,
    baud: Baud = 115200,
    *,
    options: DeviceOptions,
) -> Simulated:
    """A RoboClaw on a pseudo-terminal (packet serial)."""
    from sim_backend.devices.roboclaw.serve import RoboClawSettings, serve_roboclaw

    device = started(
        lambda: serve_roboclaw(RoboClawSettings(address=address, usb=usb, baud=baud or None, **options.values()))
    )
    drive: DriveTable = {"kind": "roboclaw", "port": device.path, "address": address}
    if baud:
        drive["baud_rate"] = baud
    return Simulated(device, "RoboClaw", drive)
