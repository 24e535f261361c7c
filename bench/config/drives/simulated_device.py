"""What a kind gives back when it has started a simulated device of its own."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from threading import Event
from typing import Protocol, Self

DriveTable = dict[str, str | int | float]  # flat, as TOML has it


class SimulatedDevice(Protocol):
    """A device at work; leaving its context ends it."""

    @property
    def path(self) -> str:
        """What a driver opens."""

    @property
    def side_channel(self) -> str:
        """Where loads are hung and faults are made, as host:port."""

    def wait(self, stop: Event) -> None:
        """Return when `stop` is set; raises what has ended the device before."""

    def __enter__(self) -> Self: ...

    def __exit__(self, *error: object) -> None: ...


@dataclass(frozen=True)
class Simulated:
    """A device that was started.

    Attributes:
        drive: `[drive]` of bench.toml that reaches it; `side_channel` is added to it.
    """

    device: SimulatedDevice
    title: str
    drive: DriveTable


Simulate = Callable[..., Simulated]
"""Takes the kind's own options, as `typer` reads them, and `options: bench.drives.device.DeviceOptions` by keyword."""


def command_in(module: str) -> Callable[[], Simulate]:
    """What imports the function `simulate` of a module once it is asked for: no bench needs it."""

    def imported() -> Simulate:
        command: Simulate = import_module(module).simulate
        return command

    return imported
