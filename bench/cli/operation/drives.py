"""`friction-bench drives`: which kinds of drive there are, and which drives answer on a port or a bus."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import typer

from bench.cli.exit_codes import ExitCode
from bench.cli.output import Json, print_json, say

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.drives.scanning import FoundDrive

app = typer.Typer(
    no_args_is_help=True,
    help="What is on a port or a bus, with the section of bench.toml that reaches it. Nothing is powered or moved.",
)


@app.callback()
def drives() -> None:
    """What is on a port or a bus, with the section of bench.toml that reaches it. Nothing is powered or moved."""


@app.command()
def scan(
    port: Annotated[str, typer.Option(help="Serial port to look at, such as /dev/ttyUSB0.")] = "",
    baud: Annotated[
        list[int] | None, typer.Option(help="Baud rate to ask at; more than once for several. Else the usual ones.")
    ] = None,
    bus: Annotated[str, typer.Option(help="CAN bus to look at, as INTERFACE:CHANNEL, such as socketcan:can0.")] = "",
    bitrate: Annotated[int, typer.Option(help="Bit rate of the bus.")] = 1_000_000,
    fd: Annotated[
        bool, typer.Option("--fd", help="Ask with CAN-FD frames, too: only where every node on the bus knows them.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Say which drives answer on a serial port or a CAN bus, and print a section [drive] for each."""
    if bool(port) == bool(bus) or (bus and ":" not in bus):
        raise typer.BadParameter("one of --port PORT and --bus INTERFACE:CHANNEL is wanted")
    found = list(found_at(port, tuple(baud or ()), bus, bitrate, fd))
    if as_json:
        print_json([{"title": one.title, "drive": one.drive} for one in found])
    for one in found if not as_json else ():
        _show(one)
    if not found:
        if not as_json:
            say("Nothing answers. Check cable, power, baud rate or bit rate; the port must not be open elsewhere.")
            if bus and not fd:
                say("A moteus on a CAN bus is asked with --fd.")
        raise typer.Exit(ExitCode.NOT_COMPLETED)


def found_at(
    port: str, baud_rates: tuple[int, ...] = (), bus: str = "", bitrate: int = 1_000_000, is_fd: bool = False
) -> "Iterator[FoundDrive]":
    """What every kind finds, one kind after the other."""
    from bench.config.drives.registry import drive_kinds
    from bench.config.drives.scanning import CanPlace, SerialPlace

    interface, _, channel = bus.partition(":")
    for kind in drive_kinds().values():
        if port and kind.scan_serial is not None:
            yield from kind.scan_serial(SerialPlace(port, baud_rates))
        if bus and kind.scan_can is not None:
            yield from kind.scan_can(CanPlace(interface, channel, bitrate, is_fd))


def _show(found: "FoundDrive") -> None:
    import tomli_w

    say(f"# {found.title}")
    say(f"[drive]\n{tomli_w.dumps(found.drive)}")
