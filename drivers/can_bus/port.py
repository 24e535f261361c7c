"""A bus as a driver of short frames uses it: send, and take in what has come, in the thread that calls."""

import time
from collections.abc import Callable, Collection
from typing import NamedTuple, TypeVar

import can

from drivers.actuator.open_buses import OpenBuses
from drivers.can_bus.bus import close_bus, open_bus, send
from drivers.can_bus.settings import BusSettings
from drivers.errors import DriveConnectionError

EXTENDED = 1 << 31  # in an identifier: it has 29 bits, as of SocketCAN
_MOST_WAITING = 2000  # frames taken in at once: a babbling node must not hold the loop


class Heard(NamedTuple):
    """The last frame of an identifier, and how many there were.

    Attributes:
        at_s: when it came, of `perf_counter` [s].
        number: how many have come.
        can_id: its identifier with the bits that say a state.
    """

    data: bytes
    at_s: float
    number: int
    can_id: int


def prepare(can_id: int, data: bytes = b"", remote: bool = False) -> can.Message:
    """A frame, which may be sent often; its identifier has 29 bits where `EXTENDED` is in it."""
    return can.Message(
        arbitration_id=can_id & ~EXTENDED, data=data, is_extended_id=bool(can_id & EXTENDED), is_remote_frame=remote,
        dlc=8 if remote else len(data),
    )  # fmt: skip


class CanPort:
    """An open bus, and the last frame of each identifier.

    Attributes:
        garbled: frames that could not be read.
        state_bits: of identifiers of 29 bits: those that say a state, and by which frames are not told apart.

    Raises:
        DriveConnectionError: it is not there, or does not open in time.
    """

    def __init__(self, settings: BusSettings) -> None:
        self._name = str(settings)
        self.garbled = self.state_bits = 0
        self._heard: dict[int, Heard] = {}
        self._bus = open_bus(settings, self._name)

    def close(self) -> None:
        """Close the bus, also a broken one. Never raises."""
        close_bus(self._bus)

    def send(self, can_id: int, data: bytes = b"", remote: bool = False) -> None:
        """Send a frame as of `prepare`, and wait for room where there is none.

        Raises:
            DriveConnectionError: there is none in time, or the adapter is gone.
        """
        self.send_prepared(prepare(can_id, data, remote))

    def send_prepared(self, message: can.Message) -> None:
        """The same of a frame that was made before.

        Raises:
            DriveConnectionError: as `send`.
        """
        try:
            send(self._bus, message)
        except (can.CanError, OSError) as error:
            raise self._lost("sending", error) from error

    def number(self, can_id: int) -> int:
        """How many frames of an identifier have come."""
        heard = self._heard.get(can_id)
        return 0 if heard is None else heard.number

    def last(self, can_id: int) -> Heard | None:
        """The last frame of an identifier; None where there was none."""
        return self._heard.get(can_id)

    def drain(self) -> None:
        """Take in what waits already.

        Raises:
            DriveConnectionError: the adapter is gone.
        """
        for _ in range(_MOST_WAITING):
            if self._take(0.0) is None:
                return

    def wait_for(self, can_ids: Collection[int], limit_s: float) -> list[int]:
        """Wait until a further frame of each identifier has come. Returns those of which none has come in time [s].

        Raises:
            DriveConnectionError: the adapter is gone.
        """
        before = {can_id: self.number(can_id) for can_id in can_ids}
        return self.wait_beyond(before, limit_s)

    def wait_beyond(self, before: dict[int, int], limit_s: float) -> list[int]:
        """The same, counted from numbers that were taken before something was asked for."""
        missing = {can_id for can_id, number in before.items() if self.number(can_id) == number}
        left_s, end_s = limit_s, time.perf_counter() + limit_s
        while missing:
            taken = self._take(max(left_s, 0.0))
            if taken is not None:
                missing.discard(taken)
            elif left_s <= 0.0:
                break
            if missing:
                left_s = end_s - time.perf_counter()
        return sorted(missing)

    def answers(self, ask: Callable[[], object], can_id: int, wait_s: float) -> int:
        """How many frames of an identifier come within a time [s] after something is asked.

        Raises:
            DriveConnectionError: the adapter is gone.
        """
        self.drain()
        before = self.number(can_id)
        ask()
        self.wait_for([-1], wait_s)  # which never comes
        return self.number(can_id) - before

    def heard_ids(self) -> list[int]:
        """Every identifier of which a frame has come."""
        return sorted(self._heard)

    def _take(self, timeout_s: float) -> int | None:
        """Take in one frame. Returns its identifier, -1 where it is none to be kept; None where none has come [s]."""
        try:
            message = self._bus.recv(timeout_s)
        except (ValueError, IndexError):  # a line that is no frame
            self.garbled += 1
            return -1
        except (can.CanError, OSError, TypeError) as error:
            raise self._lost("receiving", error) from error
        if message is None:
            return None
        if message.is_error_frame or message.is_remote_frame or not message.is_rx:
            self.garbled += message.is_error_frame
            return -1
        can_id: int = message.arbitration_id
        key = can_id
        if message.is_extended_id:
            can_id |= EXTENDED
            key = can_id & ~self.state_bits
        before = self._heard.get(key)
        number = 1 if before is None else before.number + 1
        self._heard[key] = Heard(bytes(message.data), time.perf_counter(), number, can_id)
        return key

    def _lost(self, doing: str, error: Exception) -> DriveConnectionError:
        return DriveConnectionError(
            self._name,
            f"{doing} failed: the adapter is gone, the bus is off, or nobody acknowledges ({error}); check cable, "
            "termination and bit rate, then open the drive again",
        )


MadeT = TypeVar("MadeT")
_PORTS: OpenBuses[CanPort] = OpenBuses()  # actuators on one bus share it


def on_bus(settings: BusSettings, make: Callable[[CanPort, Callable[[], None]], MadeT]) -> MadeT:
    """An actuator on a bus, which is opened where no other actuator has it open.

    Args:
        settings: how the bus is reached.
        make: makes the actuator of the port and of what gives the port back.

    Raises:
        DriveError: the bus does not open, or the actuator cannot be opened; the port is given back then.
    """
    return _PORTS.lend((settings.interface, str(settings)), lambda: CanPort(settings), make)
