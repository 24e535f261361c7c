"""`friction-bench simulate-device canopen`, and the data sheet of the drive that it simulates."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import DeviceOptions, started

if TYPE_CHECKING:  # `--help` needs no simulation
    from sim_backend.devices.process import RunningDevice


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
    eds: Annotated[
        Path | None, typer.Option(help="EDS or DCF file of a real drive: its objects, access rights and limits.")
    ] = None,
    look_s: Annotated[float, typer.Option(min=0, help="How often it looks at the controlword [s].")] = 0.0,
    enable_s: Annotated[float, typer.Option(min=0, help="What its brake takes until operation enabled [s].")] = 0.0,
    answer_s: Annotated[float, typer.Option(min=0, help="How late it answers about objects [s].")] = 0.0,
    mode_shown_enabled: Annotated[bool, typer.Option(help="It shows its mode in operation enabled alone.")] = False,
    deaf: Annotated[bool, typer.Option(help="It takes a watchdog's settings, and never watches.")] = False,
    reaction: Annotated[
        str, typer.Option(help="Without 0x6007, when the host is lost: fault, disable, quick-stop or nothing.")
    ] = "fault",
    *,
    options: DeviceOptions,
) -> Simulated:
    """A CiA 402 servo drive on a CAN bus (CANopen)."""
    from sim_backend.devices.canopen.conduct import Conduct
    from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen

    def serve() -> "RunningDevice":
        conduct = Conduct(
            look_s=look_s,
            enable_s=enable_s,
            answer_s=answer_s,
            mode_shown_enabled=mode_shown_enabled,
            deaf=deaf,
            reaction=reaction,
        )
        settings = CanOpenSettings(
            family=family,
            eds=eds,
            conduct=conduct,
            node_id=node,
            interface=interface,
            channel=channel,
            **options.values(),
        )
        return serve_canopen(settings)

    device = started(serve)
    drive: DriveTable = {"kind": "canopen", "interface": interface, "channel": device.path, "node_id": node}
    if interface == "socketcand":
        host, _, tcp_port = device.path.rpartition(":")
        drive |= {"channel": "can0", "host": host, "port": int(tcp_port)}
    return Simulated(device, f"CiA 402 drive ({eds.name if eds else family})", drive)


def electronic_data_sheet(family: str) -> str:
    """The EDS of a simulated drive of a family, on the joint of the paper."""
    from sim_backend.devices.canopen.serve import data_sheet

    return started(lambda: data_sheet(family))
