"""`friction-bench simulate-device moteus`."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import Baud, DeviceOptions, started


def simulate(
    servo_id: Annotated[int, typer.Option("--id", min=1, max=126, help="Id of the first controller.")] = 1,
    joints: Annotated[int, typer.Option(min=1, max=16, help="Controllers on the bus, with the ids that follow.")] = 1,
    uart: Annotated[bool, typer.Option("--uart", help="A controller's own UART: lines have checksums.")] = False,
    interface: Annotated[
        str, typer.Option(help="CAN-FD bus of python-can in the place of the adapter: socketcan, pcan ...")
    ] = "",
    channel: Annotated[str, typer.Option(help="Of the interface: vcan0 ...")] = "",
    baud: Baud = 0,
    *,
    options: DeviceOptions,
) -> Simulated:
    """moteus controllers behind an fdcanusb adapter, on a pseudo-terminal."""
    from sim_backend.devices.moteus.serve import MoteusBusSettings, serve_moteus

    ids = tuple(range(servo_id, servo_id + joints))
    settings = MoteusBusSettings(
        ids=ids, interface=interface, channel=channel, is_uart=uart, baud=baud or None, **options.values()
    )
    device = started(lambda: serve_moteus(settings))
    place: DriveTable = {"interface": interface, "channel": channel} if interface else {"port": device.path}
    drive: DriveTable = {"kind": "moteus", **place, "servo_id": servo_id, "over_uart": uart}
    return Simulated(device, "moteus", drive)
