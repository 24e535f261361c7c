"""`friction-bench simulate-device canopen`, and the data sheet of the drive that it simulates."""

from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import DeviceOptions, started


def simulate(
    family: Annotated[str, typer.Option(help="Objects of the drive: generic or epos4.")] = "generic",
    node: Annotated[int, typer.Option(min=1, max=127, help="Node number.")] = 5,
    interface: Annotated[
        str,
        typer.Option(
            help="slcan (a pseudo-terminal), socketcand (a TCP server here), or socketcan (the kernel's CAN)."
        ),
    ] = "slcan",
    channel: Annotated[
        str, typer.Option(help="socketcand: TCP port, 0 is any free one; socketcan: the interface, such as vcan0.")
    ] = "0",
    *,
    options: DeviceOptions,
) -> Simulated:
    """A CiA 402 servo drive on a CAN bus (CANopen)."""
    from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen

    settings = CanOpenSettings(family=family, node_id=node, interface=interface, channel=channel, **options.values())
    device = started(lambda: serve_canopen(settings))
    drive: DriveTable = {"kind": "canopen", "interface": interface, "channel": device.path, "node_id": node}
    if interface == "socketcand":
        host, _, tcp_port = device.path.rpartition(":")
        drive |= {"channel": "can0", "host": host, "port": int(tcp_port)}
    return Simulated(device, f"CiA 402 drive ({family})", drive)


def electronic_data_sheet(family: str) -> str:
    """The EDS of a simulated drive of a family, on the joint of the paper."""
    from sim_backend.devices.canopen.serve import data_sheet

    return started(lambda: data_sheet(family))
