"""`friction-bench simulate-device`: a drive in software that speaks its wire protocol, in a process of its own."""

import json as json_text
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.output import say

if TYPE_CHECKING:
    from bench.simulated_device import SimulatedDevice

Section = dict[str, str | int]

app = typer.Typer(
    no_args_is_help=True,
    help="A drive in software that speaks its wire protocol, with a simulated joint on it. Start it in one terminal, "
    "paste the section that it prints into bench.toml, and run the bench in another.",
)

Preset = Annotated[str, typer.Option(help="Plant that is simulated.")]
Plant = Annotated[Path | None, typer.Option(help="TOML file with plant parameters that differ from the preset.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the plant's scatter and noise.")]
SidePort = Annotated[int, typer.Option(min=0, max=65535, help="TCP port of the side channel; 0 is any free one.")]
Link = Annotated[Path | None, typer.Option(help="Symbolic link to put on the port, so that its name stays.")]
Baud = Annotated[int, typer.Option(min=0, help="Pace of the line in bits a second; 0 is as fast as the machine.")]
Json = Annotated[bool, typer.Option("--json", help="Print the addresses as one line of JSON, for programs.")]


@app.command()
def roboclaw(
    address: Annotated[int, typer.Option(min=128, max=135, help="Address of the drive.")] = 128,
    usb: Annotated[bool, typer.Option("--usb", help="Answer to every address, as over USB.")] = False,
    baud: Baud = 115200,
    link: Link = None,
    preset: Preset = "paper",
    plant: Plant = None,
    seed: Seed = 1,
    side_port: SidePort = 0,
    json: Json = False,
) -> None:
    """A RoboClaw on a pseudo-terminal (packet serial)."""
    from bench.simulated_device import Joint, start_roboclaw

    device = start_roboclaw(
        Joint(preset, plant, seed), address=address, usb=usb, baud=baud or None, link=link, side_port=side_port
    )
    section: Section = {"kind": "roboclaw", "port": device.path, "address": address}
    _serve(device, "RoboClaw", section, json)


def _serve(device: "SimulatedDevice", name: str, section: Section, json: bool) -> None:
    """Say where the device is, and keep it until Ctrl-C or SIGTERM."""
    from bench.simulated_device import until_told_to_end

    with until_told_to_end() as stop, device:
        if json:
            typer.echo(json_text.dumps({"port": device.path, "side_channel": device.side_channel, "drive": section}))
        else:
            say(f"{name}, simulated, on {device.path}; side channel on {device.side_channel}. For bench.toml:\n")
            say("[drive]")
            for key, value in section.items():
                say(f'{key} = "{value}"' if isinstance(value, str) else f"{key} = {value}")
            say("\nCtrl-C ends it.")
        device.wait(stop)
