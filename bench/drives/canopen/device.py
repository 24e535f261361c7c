"""`friction-bench simulate-device canopen`, and the data sheet of the drive that it simulates."""

from pathlib import Path
from typing import Annotated

import typer

from bench.config.drives.simulated_device import DriveTable, Simulated
from bench.drives.device import DeviceOptions, started


def simulate(
    family: Annotated[
        str, typer.Option(help="Objects of the drive: generic, homing (that one with homing) or epos4.")
    ] = "generic",
    eds: Annotated[
        Path | None,
        typer.Option(help="Data sheet (EDS) or configuration file (DCF) of the drive to be, instead of a family."),
    ] = None,
    node: Annotated[
        int | None, typer.Option(min=1, max=127, help="Node number; left out: what a DCF says, or 5.")
    ] = None,
    interface: Annotated[
        str,
        typer.Option(
            help="slcan (a pseudo-terminal), socketcand (a TCP server here), join (the bus of another such server), or "
            "any interface of python-can: socketcan, udp_multicast, pcan ..."
        ),
    ] = "slcan",
    channel: Annotated[
        str,
        typer.Option(
            help="socketcand: TCP port, 0 is any free one; join: host:port of the other; else the interface's: vcan0."
        ),
    ] = "0",
    look_s: Annotated[
        float, typer.Option(min=0, max=1, help="Look at the controlword every so many seconds; 0: at each.")
    ] = 0.0,
    enable_s: Annotated[
        float, typer.Option(min=0, max=60, help="Seconds from the command to operation enabled: brake, finding phase.")
    ] = 0.0,
    mode_shown_enabled: Annotated[
        bool, typer.Option("--mode-shown-enabled", help="Show the mode (0x6061) only once enabled.")
    ] = False,
    answer_s: Annotated[float, typer.Option(min=0, max=60, help="Seconds by which SDO answers are late.")] = 0.0,
    absent_code: Annotated[
        str, typer.Option(help="Abort code for an object that is not there, such as 0x08000000; left out: CiA 301's.")
    ] = "",
    refused_code: Annotated[
        str, typer.Option(help="Abort code for a write that is not allowed, such as 0x060A0023; left out: CiA 301's.")
    ] = "",
    deaf: Annotated[
        bool, typer.Option("--deaf", help="Take what a host writes to its watchdog objects, and never watch.")
    ] = False,
    sets_brake: Annotated[
        bool,
        typer.Option("--sets-brake", help="The drive sets the joint's brake itself; else bit 0 of 0x60FE sets it."),
    ] = False,
    reaction: Annotated[
        str,
        typer.Option(
            help="What a drive without 0x6007 does when its host is lost: nothing, fault, disable, quick-stop."
        ),
    ] = "fault",
    *,
    options: DeviceOptions,
) -> Simulated:
    """A CiA 402 servo drive on a CAN bus (CANopen)."""
    from sim_backend.devices.canopen.conduct import Conduct
    from sim_backend.devices.canopen.serve import CanOpenSettings, serve_canopen

    def start() -> Simulated:
        conduct = Conduct(
            look_s=look_s, enable_s=enable_s, mode_shown_enabled=mode_shown_enabled, answer_s=answer_s,
            absent_code=_code(absent_code), refused_code=_code(refused_code), deaf=deaf, sets_brake=sets_brake,
            reaction=reaction,
        )  # fmt: skip
        settings = CanOpenSettings(
            family=family, eds=eds, node_id=node, interface=interface, channel=channel, conduct=conduct,
            **options.values(),
        )  # fmt: skip
        device = serve_canopen(settings)
        title = f"CiA 402 drive ({family if eds is None else eds.name})"
        return Simulated(
            device, title, _section(interface, channel if interface == "join" else device.path, device.node_id)
        )

    return started(start)


def electronic_data_sheet(family: str) -> str:
    """The EDS of a simulated drive of a family, on the joint of the paper."""
    from sim_backend.devices.canopen.serve import data_sheet

    return started(lambda: data_sheet(family))


def _section(interface: str, path: str, node_id: int) -> DriveTable:
    """What `[drive]` says to reach it."""
    if interface not in ("socketcand", "join"):
        return {"kind": "canopen", "interface": interface, "channel": path, "node_id": node_id}
    host, _, port = path.rpartition(":")
    return {
        "kind": "canopen", "interface": "socketcand", "channel": "can0", "host": host, "port": int(port),
        "node_id": node_id,
    }  # fmt: skip


def _code(text: str) -> int | None:
    from sim_backend.errors import ParameterError

    try:
        return int(text, 0) if text else None
    except ValueError:
        raise ParameterError(f"abort code '{text}' is no number; such as 0x08000000 is wanted") from None
