"""`friction-bench simulate-device KIND`: a drive in software that speaks its wire protocol, in its own process."""

import json as json_text
import signal
import threading
from collections.abc import Callable
from dataclasses import fields
from inspect import Parameter, getdoc, signature
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer
from typer.core import TyperGroup

from bench.cli.operation.signals import handled_by
from bench.cli.output import remark, say

if TYPE_CHECKING:  # imported when needed: `--help` starts at once
    from bench.config.drives.kind import DriveKind
    from bench.config.drives.simulated_device import Simulated


class _DeviceGroup(TyperGroup):
    """One command per kind of drive that has a simulated device, made when it is asked for; and what is added here."""

    def list_commands(self, ctx: Any) -> list[str]:
        return [*_kinds(), *super().list_commands(ctx)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        kinds = _kinds()
        if cmd_name in kinds:
            return _command(kinds[cmd_name])
        if not cmd_name.startswith("-") and cmd_name not in super().list_commands(ctx):
            ctx.fail(f"There is no simulated device '{cmd_name}'; known are {', '.join(kinds)}.")
        return super().get_command(ctx, cmd_name)


app = typer.Typer(
    cls=_DeviceGroup,
    no_args_is_help=True,
    help="A drive in software that speaks its wire protocol, with a simulated joint on it.\n\n"
    "Start it in one terminal, paste the section that it prints into bench.toml, and run the bench in another.",
)


@app.command()
def eds(family: Annotated[str, typer.Option(help="Objects of the drive: generic or epos4.")] = "generic") -> None:
    """Print the electronic data sheet of the simulated CiA 402 drive, for masters that want a file."""
    from bench.drives.canopen.device import electronic_data_sheet

    typer.echo(electronic_data_sheet(family), nl=False)


def _kinds() -> "dict[str, DriveKind[Any]]":
    from bench.config.drives.registry import drive_kinds

    return {name: kind for name, kind in drive_kinds().items() if kind.simulate is not None}


def _command(kind: "DriveKind[Any]") -> Any:
    """The kind's own options and those of every device, as one command."""
    from bench.drives.device import DeviceOptions

    assert kind.simulate is not None
    simulate = kind.simulate()
    common = [field.name for field in fields(DeviceOptions)]

    def command(**values: Any) -> None:
        options = DeviceOptions(**{name: values.pop(name) for name in common})
        simulated = simulate(**values, options=options)
        _serve(options.with_limits(simulated, kind.settings.model_fields), options.json)

    _take_options(command, simulate, DeviceOptions)
    made = typer.Typer(add_completion=False, rich_markup_mode="markdown", pretty_exceptions_enable=False)
    made.command(kind.name, help=getdoc(simulate))(command)
    return typer.main.get_command(made)


def _take_options(command: Callable[..., None], *sources: Callable[..., Any]) -> None:
    """Give a command the parameters of functions or classes, one after the other: typer reads its options there."""
    parameters = [
        parameter.replace(kind=Parameter.KEYWORD_ONLY, annotation=get_type_hints(source, include_extras=True)[name])
        for source in sources
        for name, parameter in signature(source).parameters.items()
        if name != "options"
    ]
    command.__signature__ = signature(command).replace(parameters=parameters)  # type: ignore[attr-defined]
    command.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}


def _serve(simulated: "Simulated", json: bool) -> None:
    """Say where the device is, and keep it until Ctrl-C or SIGTERM."""
    device = simulated.device
    drive = simulated.drive | {"side_channel": device.side_channel}
    stop = threading.Event()
    with handled_by(lambda _number, _frame: stop.set(), (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)), device:
        if json:
            typer.echo(json_text.dumps({"port": device.path, "side_channel": device.side_channel, "drive": drive}))
        else:
            remark(f"{simulated.title}, simulated, on {device.path}; side channel on {device.side_channel}.")
            remark("For bench.toml:\n")
            say("[drive]")
            for key, value in drive.items():
                say(f"{key} = {json_text.dumps(value)}")  # a TOML value, too, where it is flat
            remark("\nCtrl-C ends it.")
        device.wait(stop)
