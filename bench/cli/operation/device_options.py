"""The options that every simulated device has, told once."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

if TYPE_CHECKING:
    from bench.doctor.simulated_device import Joint


@dataclass(frozen=True)
class DeviceOptions:
    """The joint behind a device, and where the device is to be found."""

    link: Annotated[Path | None, typer.Option(help="Symbolic link to put on the port, so that its name stays.")] = None
    preset: Annotated[str, typer.Option(help="Plant that is simulated.")] = "paper"
    plant: Annotated[Path | None, typer.Option(help="TOML file with plant parameters that differ from the preset.")] = (
        None
    )
    seed: Annotated[int, typer.Option(min=0, help="Seed of the plant's scatter and noise.")] = 1
    side_port: Annotated[
        int, typer.Option(min=0, max=65535, help="TCP port of the side channel; 0 is any free one.")
    ] = 0
    patience: Annotated[
        float | None,
        typer.Option(
            min=0.001,
            max=1.0,
            metavar="SECONDS",
            help="For a machine that is busy with other work, whose host is late at times: while the motor is powered "
            "or the joint moves, the drive's time goes no further than this without a word of the host.",
        ),
    ] = None
    json: Annotated[bool, typer.Option("--json", help="Print the addresses as one line of JSON, for programs.")] = False

    def joint(self) -> "Joint":
        """The joint behind the device."""
        from bench.doctor.simulated_device import Joint

        return Joint(self.preset, self.plant, self.seed)

    def place(self) -> dict[str, Any]:
        """Where it is to be found, as the settings of every device take it."""
        return {"link": self.link, "side_port": self.side_port, "patience_s": self.patience}


def with_device_options(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command these options after its own; it takes them as its last argument, `options`."""
    names = [field.name for field in fields(DeviceOptions)]

    @wraps(command)
    def with_options(**values: Any) -> None:
        options = DeviceOptions(**{name: values.pop(name) for name in names})
        command(**values, options=options)

    hints = get_type_hints(DeviceOptions, include_extras=True)
    own = [parameter for name, parameter in signature(command).parameters.items() if name != "options"]
    common = [
        Parameter(field.name, Parameter.KEYWORD_ONLY, default=field.default, annotation=hints[field.name])
        for field in fields(DeviceOptions)
    ]
    # what typer reads the options of a command from
    with_options.__signature__ = signature(command).replace(parameters=[*own, *common])  # type: ignore[attr-defined]
    with_options.__annotations__ = {parameter.name: parameter.annotation for parameter in (*own, *common)}
    return with_options
