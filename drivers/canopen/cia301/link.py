"""The bus as the driver uses it: bounded sends, and receiving in the thread that calls.

Everything that comes in is handed out by `receive` and `drain` in the control loop's own thread. There is no receiving
thread: no frame waits for a thread switch, and what a handler raises is raised in the loop.
"""

import struct
from typing import TYPE_CHECKING

import can
import canopen

from drivers.can_bus.bus import is_full, send
from drivers.errors import DriveConnectionError

if TYPE_CHECKING:
    from drivers.canopen.cia301.sync_cycle import SyncCycle
from collections import Counter

from drivers.can_bus.bus import close_bus, open_bus
from drivers.can_bus.settings import BusSettings

_MOST_WAITING = 2000  # frames taken in at once: a babbling node must not hold the loop
_BUS_OFF = 0x40  # error class of a SocketCAN error frame (linux/can/error.h)


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


class CanLink(canopen.Network):
    """One drive's access to a CAN bus, open or not. Whichever link receives hands out to all of the bus.

    Attributes:
        garbled: frames that could not be read, or were not what their COB-ID promises.
        cycle: of the drive; None before it has one.
        host_id: node ID of this host towards the drive; None before it has one.
        load: bytes of the frames of a cycle of the drive.
    """

    def __init__(self, port: BusPort, device: str) -> None:
        super().__init__()
        self.port = port
        self._device = device
        self._echoes = port.echoes
        self.garbled = 0
        self.cycle: SyncCycle | None = None
        self.host_id: int | None = None
        self.load: tuple[int, ...] = ()

    def open(self) -> None:
        """Open the bus.

        Raises:
            DriveConnectionError: it is not there, or does not open in time.
        """
        self.bus = self.port.join(self, self._device)

    def close(self) -> None:
        """Close the bus where nobody else of this bench uses it, also a broken one. Never raises."""
        if self.bus is not None:
            self.bus = None
            self.port.leave(self)

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send one frame.

        Raises:
            DriveConnectionError: the port is gone, the bus is off, or the transmit buffer stays full.
        """
        self.send_prepared(prepare(can_id, data, remote))

    def send_prepared(self, message: can.Message) -> None:
        """Send a frame that was made before; as `send_message`."""
        if self.bus is None:
            raise DriveConnectionError(self._device, "the bus is closed; open the drive first")
        try:
            send(self.bus, message)
        except (can.CanError, OSError) as error:
            raise self._lost("sending", error) from error
        if self._echoes is not None:
            self._echoes[message.arbitration_id, bytes(message.data)] += 1

    def receive(self, timeout_s: float) -> bool:
        """Wait for one frame, and hand it to its handler.

        Returns:
            Whether there was one, readable or not.

        Raises:
            DriveConnectionError: the port is gone, or the bus is off.
        """
        if self.bus is None:
            raise DriveConnectionError(self._device, "the bus is closed; open the drive first")
        try:
            message = self.bus.recv(timeout_s)
        except (ValueError, IndexError):  # a line that is no frame
            self.garbled += 1
            return True
        except (can.CanError, OSError) as error:
            raise self._lost("receiving", error) from error
        if message is None:
            return False
        if message.is_error_frame:
            self._check(message)
        elif not message.is_remote_frame and message.is_rx and not self._is_echo(message):
            for link in self.port.links:
                link.hand_out(message)
        return True

    def drain(self) -> None:
        """Hand out every frame that waits already, without waiting for more."""
        for _ in range(_MOST_WAITING):
            if not self.receive(0.0):
                return

    def _is_echo(self, message: can.Message) -> bool:
        """Whether a frame is one of this host's own, come back: it is no word of another host."""
        key = (message.arbitration_id, bytes(message.data))
        if self._echoes is None or not self._echoes[key]:
            return False
        self._echoes[key] -= 1
        return True

    def hand_out(self, message: can.Message) -> None:
        """Give a frame to those who have subscribed to it."""
        try:
            for handler in self.subscribers.get(message.arbitration_id, ()):
                handler(message.arbitration_id, message.data, message.timestamp)
        except (ValueError, struct.error):
            self.garbled += 1

    def _check(self, message: can.Message) -> None:
        self.garbled += 1
        if self.port.settings.interface == "socketcan" and message.arbitration_id & _BUS_OFF:
            raise DriveConnectionError(
                self._device, "the bus is off after too many errors; check wiring, termination and bit rate, then open"
            )

    def _lost(self, doing: str, error: Exception) -> DriveConnectionError:
        what = f"the adapter is gone, or broken ({error})"
        if is_full(error):
            what = "the transmit buffer stays full: nobody acknowledges"
        return DriveConnectionError(
            self._device, f"{doing} failed: {what}; check cable, adapter and bit rate, then open the drive again"
        )


def prepare(can_id: int, data: bytes, remote: bool = False) -> can.Message:
    """A frame for `CanLink.send_prepared`, which may be sent often."""
    return can.Message(arbitration_id=can_id, data=data, is_extended_id=False, is_remote_frame=remote)
