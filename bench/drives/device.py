"""The options that every `friction-bench simulate-device KIND` has beside its own."""

from collections.abc import Callable, Container
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, TypeVar

import typer

from bench.config.drives.simulated_device import Simulated
from bench.config.toml_text import read_toml
from bench.errors import ConfigurationError
from bench.json_types import Values

Baud = Annotated[int, typer.Option(min=0, help="Pace of the line in bits a second; 0 is as fast as the machine.")]
Interface = Annotated[
    str, typer.Option(help="slcan (a pseudo-terminal), or any interface of python-can: socketcan, pcan ...")
]
Channel = Annotated[str, typer.Option(help="Of the interface: vcan0 ...")]
Made = TypeVar("Made")

# [s], of a drive whose time waits for the host: a shorter watchdog would not have acted yet when it is tried
PATIENT_LIMITS = {"watchdog_s": 1.0, "answer_timeout_s": 0.3, "answer_s": 0.3}


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
            "or the joint moves, the drive's time goes no further than this without a word of the host. The printed "
            "section has the time limits for it.",
        ),
    ] = None
    json: Annotated[bool, typer.Option("--json", help="Print the addresses as one line of JSON, for programs.")] = False

    def values(self) -> dict[str, Any]:
        """As the settings of every simulated device take them.

        Raises:
            ConfigurationError: the file with plant parameters cannot be read, or is no TOML.
        """
        return {
            "link": self.link,
            "preset": self.preset,
            "plant": self._plant_tables(),
            "seed": self.seed,
            "side_port": self.side_port,
            "patience_s": self.patience,
        }

    def with_limits(self, simulated: Simulated, keys: Container[str]) -> Simulated:
        """The same, with the time limits of a patient device in its section; limits of the device itself stay.

        Args:
            simulated: as its kind has made it.
            keys: that `[drive]` of the kind has.
        """
        if self.patience is None:
            return simulated
        limits = {name: value for name, value in PATIENT_LIMITS.items() if name in keys}
        return replace(simulated, drive=simulated.drive | limits | simulated.drive)

    def _plant_tables(self) -> Values:
        if self.plant is None:
            return {}
        return read_toml(self.plant)


def started(make: Callable[[], Made]) -> Made:
    """What `make` returns; what the simulation refuses is an error of the configuration.

    Raises:
        ConfigurationError: the joint cannot be, or a port is taken.
    """
    from sim_backend.errors import ParameterError

    try:
        return make()
    except (ParameterError, OSError) as error:
        raise ConfigurationError(f"simulated device: {error}") from error
