"""`friction-bench simulate-device dynamixel`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import Baud, DeviceOptions, started


def simulate(
    model: Annotated[str, typer.Option(help="XM430-W350, XL330-M288 or XL430-W250.")] = "XM430-W350",
    servo_id: Annotated[int, typer.Option("--id", min=0, max=252, help="Id of the first servo.")] = 1,
    joints: Annotated[int, typer.Option(min=1, max=16, help="Servos on the line, with the ids that follow.")] = 1,
    twins: Annotated[bool, typer.Option("--twins", help="Two servos of one id, which answer at once.")] = False,
    baud: Baud = 57600,
    *,
    options: DeviceOptions,
) -> Simulated:
    """Dynamixel X servos on a pseudo-terminal (protocol 2.0)."""
    from sim_backend.devices.dynamixel.serve import DynamixelBusSettings, serve_dynamixel

    ids = (servo_id, servo_id) if twins else tuple(range(servo_id, servo_id + joints))
    settings = DynamixelBusSettings(model=model, ids=ids, baud=baud or None, **options.values())
    device = started(lambda: serve_dynamixel(settings))
    drive: DriveTable = {"kind": "dynamixel", "port": device.path, "servo_id": servo_id}
    if baud:
        drive["baud_rate"] = baud
    return Simulated(device, f"Dynamixel {model}", drive)
