"""Other hosts on the bus: a second SYNC, NMT commands, demands or heartbeats that are not this host's own.

One bus has one SYNC producer, and one drive has one host. A second SYNC makes the drive answer at times that this host
does not know; a second host under the same node ID keeps a drive alive whose own host is gone. The link drops what
comes back of this host's own frames, so each of these was sent by somebody else.
"""

import itertools
import os
from collections.abc import Callable, Iterable
from typing import Final

from drivers.canopen.cia301.link import CanLink
from drivers.errors import DriveConnectionError

_NMT, _SYNC, _HEARTBEAT = 0x000, 0x080, 0x700
_RPDOS: Final = (0x200, 0x300, 0x400, 0x500)
_REQUEST: Final = 0x600
_HOST_IDS: Final = range(64, 128)  # where the host's own node ID is chosen from: drives have small ones
_NUMBERS = itertools.count()


class Strangers:
    """Listens for what only another host sends, and names it.

    Attributes:
        heard: node IDs whose heartbeats or boot-ups have been heard.
    """

    def __init__(self, link: CanLink, device: str, node_id: int) -> None:
        self._device = device
        self._node_id = node_id
        self._link = link
        self._host_id: int | None = None
        self._seen = ""
        self.heard: set[int] = set()
        link.subscribe(_NMT, self._take_nmt)
        link.subscribe(_SYNC, self._named("SYNC (COB-ID 0x80): a bus has one SYNC producer"))
        for base in _RPDOS:
            link.subscribe(base + node_id, self._named(f"demands to this drive (COB-ID 0x{base + node_id:X})"))
        link.subscribe(_REQUEST + node_id, self._named(f"SDO requests to this drive (COB-ID 0x{0x600 + node_id:X})"))
        for other in range(1, 128):
            if other != node_id:
                link.subscribe(_HEARTBEAT + other, self._take_heartbeat)

    def choose_host_id(self, configured: int | None) -> int:
        """The node ID of this host: the one that is configured, or one of its own that nobody uses.

        Raises:
            DriveConnectionError: somebody uses the one that is configured, or all are used.
        """
        # one for each drive: its watchdog stops it where this host goes on with the others alone
        taken = self.heard | {self._node_id} | {one.host_id for one in self._link.port.links}
        free = [number for number in _own_order() if number not in taken]
        if configured is not None and configured in self.heard:
            raise DriveConnectionError(
                self._device,
                f"another node sends heartbeats as node {configured}, which host_node_id claims for this host: it "
                "would keep the drive alive without it. Choose another host_node_id, or leave it out",
            )
        if configured is None and not free:
            raise DriveConnectionError(
                self._device, "every node ID 64 .. 127 is in use; set host_node_id to a free one"
            )
        self._host_id = free[0] if configured is None else configured
        return self._host_id

    def forget(self) -> None:
        """Begin anew: what was heard may be over."""
        self._seen = ""

    def check(self) -> None:
        """Refuse to go on where another host has been heard.

        Raises:
            DriveConnectionError: naming what it sends.
        """
        if self._seen:
            raise DriveConnectionError(
                self._device,
                f"another host is on the bus: it sends {self._seen}. End it, then open the drive again",
            )

    def _named(self, what: str) -> Callable[[int, bytearray, float], None]:
        def take(_cob_id: int, _data: bytearray, _timestamp: float) -> None:
            self._seen = self._seen or what

        return take

    def _take_nmt(self, _cob_id: int, data: bytearray, _timestamp: float) -> None:
        if len(data) == 2 and data[1] in (0, self._node_id):
            self._seen = self._seen or "NMT commands to this drive (COB-ID 0x000)"

    def _take_heartbeat(self, cob_id: int, _data: bytearray, _timestamp: float) -> None:
        number = cob_id - _HEARTBEAT
        self.heard.add(number)
        if number == self._host_id:
            self._seen = self._seen or (
                f"heartbeats as node {number}, the ID of this host (host_node_id): they keep the drive alive without it"
            )


def _own_order() -> Iterable[int]:
    """Host IDs in an order that differs between processes, and between the drives of one."""
    first = os.getpid() * 7 + next(_NUMBERS) * 13
    return (_HOST_IDS[(first + step) % len(_HOST_IDS)] for step in range(len(_HOST_IDS)))
