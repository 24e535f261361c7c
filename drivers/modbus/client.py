"""pymodbus' serial client, made for a control loop: it waits for bytes instead of looking for them now and then."""

import time

from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient
from pymodbus.exceptions import ModbusException

from drivers.modbus.settings import ModbusSettings

_READS = frozenset({1, 2, 3, 4, 23})  # answered with address, function, number of bytes, data, CRC
_SHORTEST_BYTES = 5  # an exception: address, function, code, CRC
_WRITE_BYTES = 8  # address, function, register, value or number, CRC
_REFUSED = 0x80


class QuickSerialClient(ModbusSerialClient):
    """pymodbus' own client looks for bytes once a millisecond, twice for each answer; this one waits for whole answers.

    Args:
        settings: port, baud rate, time limit, local echo.
    """

    def __init__(self, settings: ModbusSettings) -> None:
        super().__init__(
            settings.port, framer=FramerType.RTU, baudrate=settings.baud_rate, parity=settings.parity,
            stopbits=settings.stop_bits, timeout=settings.answer_timeout_s, retries=0,
        )  # fmt: skip
        self._has_echo, self._silence_s = settings.echo, settings.line_silence_s
        self._free_at_s = 0.0  # when the line has been silent for long enough

    def send(self, request: bytes, addr: tuple[str, int] | None = None) -> int:
        """Wait until the line has been silent for 3.5 characters, then send; hear what an adapter with echo sends back.

        Raises:
            ModbusException: the echo is not what was sent: two talk at once, or there is none.
        """
        wait_s = self._free_at_s - time.perf_counter()
        if wait_s > 0.0:
            time.sleep(wait_s)
        sent: int = super().send(request, addr)
        if self._has_echo and self.socket is not None and (heard := self.socket.read(len(request))) != request:
            raise ModbusException(
                f"the echo of {request.hex(' ')} is {heard.hex(' ') or 'missing'}; "
                "does the adapter send one (drive.echo), and does nobody else talk?"
            )
        return sent

    def recv(self, size: int | None) -> bytes:
        """The bytes of one answer, by the length that its head tells; what there is after the time limit."""
        port = self.socket
        if size is not None or port is None:
            return super().recv(size)
        try:
            data: bytes = port.read(_SHORTEST_BYTES)
            missing = _length(data) - len(data)
            if missing > 0 and len(data) == _SHORTEST_BYTES:
                data += port.read(missing)
            if len(data) < _length(data):  # the host may have been away, and the rest be there by now
                data += port.read(min(port.in_waiting, _length(data) - len(data)))
        except OSError:
            self.close()  # type: ignore[no-untyped-call]
            raise ModbusException("the port is gone") from None
        self._free_at_s = time.perf_counter() + self._silence_s
        return data


def _length(data: bytes) -> int:
    """Bytes of the answer that begins so."""
    if len(data) < 3 or data[1] & _REFUSED:
        return _SHORTEST_BYTES
    return _SHORTEST_BYTES + data[2] if data[1] in _READS else _WRITE_BYTES
