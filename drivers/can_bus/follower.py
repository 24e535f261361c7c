"""An actuator that another host drives on a CAN bus: what it tells that host is heard, and nothing is sent."""

from collections.abc import Callable
from time import perf_counter

from drivers.actuator.reading import Reading, sample_of
from drivers.can_bus.port import CanPort, Heard
from drivers.can_bus.settings import BusSettings
from drivers.contract import Sample, Status
from drivers.joint import JointScale

ReadingOf = Callable[[CanPort, Heard], Reading | None]
"""A frame in SI, with what else was heard on the port; None where it is of another one, or tells no motion."""


class BusFollower:
    """One actuator on a bus that is listened to. It needs an adapter of its own, or a bus that is shared (SocketCAN).

    Args:
        bus: how it is reached.
        can_id: identifier of the frames that tell its motion, as of `CanPort`.
        names: what it is, and its name in messages.
        reading_of: takes such a frame apart.
        joint: scales and signs.
        state_bits: of `CanPort`.

    Raises:
        DriveConnectionError: the bus is not there, or does not open.
    """

    is_between = False

    def __init__(
        self, bus: BusSettings, can_id: int, names: tuple[str, str], reading_of: ReadingOf, joint: JointScale,
        state_bits: int = 0,
    ) -> None:  # fmt: skip
        self.product, self.device = names
        self.wanted = f"drive it on the bus {bus}, and have it answer or report its position: nothing is sent from here"
        self._can_id, self._reading_of, self._joint = can_id & ~state_bits, reading_of, joint
        self._heard_s = float("-inf")
        self._port = CanPort(bus.listening())
        self._port.state_bits = state_bits

    @property
    def silent_s(self) -> float:
        """How long it has told nothing [s]."""
        return perf_counter() - self._heard_s

    def look(self, timeout_s: float) -> Sample | None:
        """Wait for its next frame [s]; None where none comes, or one that tells no motion."""
        if self._port.wait_for([self._can_id], timeout_s):
            return None
        heard = self._port.last(self._can_id)
        reading = None if heard is None else self._reading_of(self._port, heard)
        if reading is None:
            return None
        self._heard_s = reading.asked_s
        return sample_of(reading, self._joint, Status.ENABLED if reading.is_on else Status.DISABLED)

    def close(self) -> None:
        """Give the bus back. Never raises."""
        self._port.close()
