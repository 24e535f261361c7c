"""`friction-bench simulate-device odrive`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import Simulated
from bench.drives.device import Channel, DeviceOptions, Interface, started


def simulate(
    node: Annotated[int, typer.Option(min=0, max=62, help="Node ID of the axis.")] = 0,
    watchdog: Annotated[
        float, typer.Option(min=0, max=10, metavar="SECONDS", help="Its watchdog; 0: not enabled.")
    ] = 0.2,
    interface: Interface = "slcan",
    channel: Channel = "0",
    *,
    options: DeviceOptions,
) -> Simulated:
    """An ODrive axis on a CAN bus (CANSimple)."""
    from sim_backend.devices.odrive.serve import OdriveSimulation, serve_odrive

    settings = OdriveSimulation(
        node_id=node, watchdog_s=watchdog or None, interface=interface, channel=channel, **options.values()
    )
    device = started(lambda: serve_odrive(settings))
    return Simulated(device, "ODrive, CANSimple", {
        "kind": "odrive", "interface": interface, "channel": device.path, "node_id": node,
        "watchdog_is_set_in_drive": bool(watchdog), "watchdog_s": watchdog or 0.2,
    })  # fmt: skip
