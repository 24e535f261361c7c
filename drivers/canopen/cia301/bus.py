"""A CAN bus of python-can: opened and closed in bounded time, by the drives that are on it."""

import socket
from collections import Counter
from contextlib import suppress
from typing import TYPE_CHECKING

import can

from drivers.canopen.cia301.bounded import bounded
from drivers.canopen.cia301.slcan_bus import SlcanBus
from drivers.canopen.settings import BusSettings
from drivers.errors import DriveConnectionError

if TYPE_CHECKING:
    from drivers.canopen.cia301.link import CanLink

_OPEN_S = 3.0
_CLOSE_S = 1.0
_KNOCK_S = 2.0

_NEXT_STEP = {
    "socketcan": "is the interface there and up? `ip link set {channel} up type can bitrate {bitrate}`",
    "slcan": "is the adapter plugged in, the port right and nobody else using it?",
    "socketcand": "does socketcand run at {host}:{port}, and does it offer {channel}?",
    "virtual": "it exists inside one process only",
}
_WITHOUT_DRIVER = (
    ImportError,
    NameError,
    AttributeError,
)  # what interfaces raise where the vendor's library is missing
_ANY_STEP = "is the adapter plugged in, its driver installed, and `channel` as python-can's documentation has it?"


class BusPort:
    """One bus, opened for the first link to it and closed with the last. All its links are used by one thread.

    Args:
        settings: how it is reached.

    Attributes:
        links: that are open.
        echoes: frames sent that come back, by COB-ID and data; None where the interface echoes nothing.
    """

    def __init__(self, settings: BusSettings) -> None:
        self.settings = settings
        self.links: tuple[CanLink, ...] = ()
        self.echoes: Counter[tuple[int, bytes]] | None = Counter() if settings.echoes else None
        self._bus: can.BusABC | None = None

    def join(self, link: "CanLink", device: str) -> can.BusABC:
        """The bus, open.

        Raises:
            DriveConnectionError: it is not there, or does not open in time.
        """
        if self._bus is None:
            self._bus = open_bus(self.settings, device)
        self.links = (*self.links, link)
        return self._bus

    def leave(self, link: "CanLink") -> None:
        """Close the bus, where no other link uses it. Never raises."""
        self.links = tuple(one for one in self.links if one is not link)
        if not self.links and self._bus is not None:
            bus, self._bus = self._bus, None
            close_bus(bus)


def open_bus(settings: BusSettings, device: str) -> can.BusABC:
    """Open a bus.

    Raises:
        DriveConnectionError: it is not there, or does not open in time.
    """
    arguments = settings.arguments()
    timeout_s = _OPEN_S + settings.adapter_start_s
    try:
        if settings.interface == "socketcand":
            # python-can would knock ten seconds long, without a pause
            socket.create_connection((settings.host, settings.port), timeout=_KNOCK_S).close()
        if settings.interface != "slcan":
            return bounded(lambda: can.Bus(**arguments), timeout_s, undo=lambda bus: bus.shutdown())
        del arguments["interface"], arguments["ignore_config"]
        return bounded(lambda: SlcanBus(**arguments), timeout_s, undo=lambda bus: bus.shutdown())
    except (can.CanError, OSError, ValueError, TypeError, *_WITHOUT_DRIVER) as error:
        step = _NEXT_STEP.get(settings.interface, _ANY_STEP).format(
            channel=settings.channel,
            bitrate=settings.bitrate,
            host=settings.host,
            port=settings.port,
        )
        raise DriveConnectionError(
            device, f"the bus {settings.interface} {settings} does not open: {error}; {step}"
        ) from error


def close_bus(bus: can.BusABC) -> None:
    """Close a bus, also one that is broken. Never raises, never hangs."""
    with suppress(Exception):
        bounded(bus.shutdown, _CLOSE_S)
