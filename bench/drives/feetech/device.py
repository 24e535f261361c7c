"""`friction-bench simulate-device feetech`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import Baud, DeviceOptions, started


def simulate(
    servo_id: Annotated[int, typer.Option("--id", min=0, max=253, help="Id of the first servo.")] = 1,
    joints: Annotated[int, typer.Option(min=1, max=16, help="Servos on the line, with the ids that follow.")] = 1,
    twins: Annotated[bool, typer.Option("--twins", help="Two servos of one id, which answer at once.")] = False,
    baud: Baud = 1_000_000,
    *,
    options: DeviceOptions,
) -> Simulated:
    """Feetech STS3215 servos on a pseudo-terminal (SCS protocol)."""
    from sim_backend.devices.feetech.serve import FeetechBusSettings, serve_feetech

    ids = (servo_id, servo_id) if twins else tuple(range(servo_id, servo_id + joints))
    device = started(lambda: serve_feetech(FeetechBusSettings(ids=ids, baud=baud or None, **options.values())))
    drive: DriveTable = {
        "kind": "feetech", "port": device.path, "servo_id": servo_id, "accept_no_watchdog": True,
    }  # fmt: skip
    if baud:
        drive["baud_rate"] = baud
    return Simulated(device, "Feetech STS3215", drive)
