"""RPDOs: commands that come without being asked for."""

from enum import Enum

from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.mapping import Mapped, PdoParameters

_SYNCHRONOUS = range(241)


class Taken(Enum):
    """What became of an RPDO."""

    YES = 0
    TOO_SHORT = 1
    TOO_LONG = 2  # taken all the same, without its end


class ReceivePdo:
    """One RPDO: of a synchronous one the data wait for the next SYNC, and the last that came before it counts."""

    def __init__(self, dictionary: Dictionary, number: int) -> None:
        self._dictionary = dictionary
        self._parameters = PdoParameters(dictionary, 0x1400 + number, 0x1600 + number, received=True)
        self._parameters.on_change(self.renew)
        self._waiting: bytes | None = None
        self.can_id: int | None = None
        self._mapped: Mapped = ()
        self.renew()

    def renew(self) -> None:
        """Take the parameters as they are now."""
        parameters = self._parameters
        self._mapped = parameters.mapped()
        self.can_id = parameters.can_id if parameters.exists and self._mapped else None
        self._synchronous = parameters.type in _SYNCHRONOUS
        self._length = sum(length for _, _, length in self._mapped)
        self._waiting = None

    def receive(self, data: bytes) -> Taken:
        """Take what came."""
        if len(data) < self._length:
            return Taken.TOO_SHORT
        if self._synchronous:
            self._waiting = data
        else:
            self._apply(data)
        return Taken.TOO_LONG if len(data) > self._length else Taken.YES

    def sync(self) -> None:
        """Obey what has been waiting."""
        if self._waiting is not None:
            data, self._waiting = self._waiting, None
            self._apply(data)

    def _apply(self, data: bytes) -> None:
        place = 0
        for index, subindex, length in self._mapped:
            self._dictionary.write_by_pdo(index, subindex, data[place : place + length])
            place += length
