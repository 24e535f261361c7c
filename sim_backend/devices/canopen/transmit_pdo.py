"""TPDOs: measurements that go out without being asked for."""

from sim_backend.devices.can.frame import Frame
from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.mapping import Mapped, PdoParameters

_ON_EVENT = (254, 255)


class TransmitPdo:
    """One TPDO.

    Transmission type 0: at the SYNC after a change; 1 .. 240: at every so many SYNCs; 254, 255: at a change, not more
    often than the inhibit time, and whenever the event timer is over.
    """

    def __init__(self, dictionary: Dictionary, number: int) -> None:
        self._dictionary = dictionary
        self._link = 0x1800 + number
        self._parameters = PdoParameters(dictionary, self._link, 0x1A00 + number, received=False)
        self._parameters.on_change(self.renew)
        self._mapped: Mapped = ()
        self.renew()

    def renew(self) -> None:
        """Take the parameters as they are now, and begin anew."""
        parameters = self._parameters
        self._mapped = parameters.mapped()
        self._lives = parameters.exists and bool(self._mapped)
        self._type = parameters.type
        self._can_id = parameters.can_id
        self._syncs = 0
        self._sent: bytes | None = None
        self._sent_s = 0.0

    def sync(self, time_s: float) -> Frame | None:
        """Return what goes out at a SYNC."""
        if not self._lives or self._type in _ON_EVENT:
            return None
        if self._type == 0:
            data = self._data()
            return self._send(data, time_s) if data != self._sent else None
        self._syncs += 1
        if self._syncs < self._type:
            return None
        self._syncs = 0
        return self._send(self._data(), time_s)

    def poll(self, time_s: float) -> Frame | None:
        """Return what goes out by itself now."""
        if not self._lives or self._type not in _ON_EVENT:
            return None
        data = self._data()
        since_s = time_s - self._sent_s
        inhibit_s = self._dictionary.number(self._link, 3) * 1e-4
        timer_s = self._dictionary.number(self._link, 5) * 1e-3
        first = self._sent is None
        changed = data != self._sent and since_s >= inhibit_s - 1e-9
        over = timer_s > 0.0 and since_s >= timer_s - 1e-9
        return self._send(data, time_s) if first or changed or over else None

    def _send(self, data: bytes, time_s: float) -> Frame:
        self._sent, self._sent_s = data, time_s
        return Frame(self._can_id, data)

    def _data(self) -> bytes:
        return b"".join(self._dictionary.content(index, subindex) for index, subindex, _ in self._mapped)
