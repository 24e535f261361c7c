"""One bus, as the CANopen drives that are on it use it together."""

from collections import Counter
from typing import TYPE_CHECKING

import can

from drivers.can_bus.bus import close_bus, open_bus
from drivers.can_bus.settings import BusSettings

if TYPE_CHECKING:
    from drivers.canopen.cia301.link import CanLink


class BusPort:
    """One bus, opened for the first link to it and closed with the last. All its links are used by one thread.

    Attributes:
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
