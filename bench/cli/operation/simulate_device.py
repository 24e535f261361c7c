"""`friction-bench simulate-device`: a drive in software that speaks its wire protocol, in a process of its own."""

import json as json_text
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.operation.device_options import DeviceOptions, with_device_options
from bench.cli.output import say

if TYPE_CHECKING:
    from bench.doctor.simulated_device import SimulatedDevice

Section = dict[str, str | int | float]

app = typer.Typer(
    no_args_is_help=True,
    help="A drive in software that speaks its wire protocol, with a simulated joint on it.\n\n"
    "Start it in one terminal, paste the section that it prints into bench.toml, and run the bench in another.",
)

Baud = Annotated[int, typer.Option(min=0, help="Pace of the line in bits a second; 0 is as fast as the machine.")]


@app.command()
@with_device_options
def roboclaw(
    address: Annotated[int, typer.Option(min=128, max=135, help="Address of the drive.")] = 128,
    usb: Annotated[bool, typer.Option("--usb", help="Answer to every address, as over USB.")] = False,
    baud: Baud = 115200,
    *,
    options: DeviceOptions,
) -> None:
    """A RoboClaw on a pseudo-terminal (packet serial)."""
    from bench.doctor.simulated_device import start_roboclaw

    device = start_roboclaw(options.joint(), address=address, usb=usb, baud=baud or None, **options.place())
    section: Section = {"kind": "roboclaw", "port": device.path, "address": address}
    if baud:
        section["baud_rate"] = baud
    _serve(device, "RoboClaw", section, options.json)


@app.command()
@with_device_options
def canopen(
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
) -> None:
    """A CiA 402 servo drive on a CAN bus (CANopen)."""
    from bench.doctor.simulated_device import start_canopen

    device = start_canopen(
        options.joint(), family=family, node_id=node, interface=interface, channel=channel, **options.place(),
    )  # fmt: skip
    section: Section = {"kind": "canopen", "interface": interface, "channel": device.path, "node_id": node}
    if interface == "socketcand":
        host, _, tcp_port = device.path.rpartition(":")
        section |= {"channel": "can0", "host": host, "port": int(tcp_port)}
    _serve(device, f"CiA 402 drive ({family})", section, options.json)


@app.command()
@with_device_options
def modbus(
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
) -> None:
    """A drive on Modbus RTU or TCP; docs/modbus-map.md is its manual."""
    from bench.doctor.simulated_device import start_modbus

    device = start_modbus(
        options.joint(),
        map=map_, transport=transport, unit=unit, low_word_first=low_word_first, baud=baud or None, port=port,
        **options.place(),
    )  # fmt: skip
    section: Section = {"kind": "modbus", "map": map_, "transport": transport, "unit": unit}
    if transport == "tcp":
        host, number = device.path.split(":")
        section |= {"host": host, "port": number}
    else:
        section |= {"port": device.path, "baud_rate": baud or 115200}
    if map_ == "roboteq":  # its watchdog has no register
        section |= {"watchdog_s": 1.0, "watchdog_is_set_in_drive": True}
    _serve(device, f"Modbus drive ({map_})", section, options.json)


@app.command()
def eds(family: Annotated[str, typer.Option(help="Objects of the drive: generic or epos4.")] = "generic") -> None:
    """Print the electronic data sheet of the simulated CiA 402 drive, for masters that want a file."""
    from bench.doctor.simulated_device import electronic_data_sheet

    typer.echo(electronic_data_sheet(family), nl=False)


def _serve(device: "SimulatedDevice", name: str, section: Section, json: bool) -> None:
    """Say where the device is, and keep it until Ctrl-C or SIGTERM."""
    from bench.doctor.simulated_device import until_told_to_end

    section |= {"side_channel": device.side_channel}
    with until_told_to_end() as stop, device:
        if json:
            typer.echo(json_text.dumps({"port": device.path, "side_channel": device.side_channel, "drive": section}))
        else:
            say(f"{name}, simulated, on {device.path}; side channel on {device.side_channel}. For bench.toml:\n")
            say("[drive]")
            for key, value in section.items():
                say(f"{key} = {json_text.dumps(value)}")  # a TOML value, too, where it is flat
            say("\nCtrl-C ends it.")
        device.wait(stop)
