"""What `friction-bench drives scan` asks a kind of drive, and what the kind finds."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from bench.config.drives.simulated_device import DriveTable


@dataclass(frozen=True)
class SerialPlace:
    """A serial port to be looked at.

    Attributes:
        port: "/dev/ttyUSB0".
        baud_rates: at which to ask; empty: those that the kind is delivered with.
    """

    port: str
    baud_rates: tuple[int, ...] = ()


@dataclass(frozen=True)
class CanPlace:
    """A CAN bus to be looked at.

    Attributes:
        bitrate: of the bus [bit/s].
        is_fd: whether every node on it knows CAN-FD.
    """

    interface: str
    channel: str
    bitrate: int = 1_000_000
    is_fd: bool = False


@dataclass(frozen=True)
class FoundDrive:
    """What answers.

    Attributes:
        drive: `[drive]` of bench.toml that reaches it.
    """

    title: str
    drive: DriveTable


SerialScan = Callable[[SerialPlace], Iterator[FoundDrive]]
CanScan = Callable[[CanPlace], Iterator[FoundDrive]]
"""A scan only asks: nothing that it sends moves or powers anything. It raises `DriveConnectionError`."""
