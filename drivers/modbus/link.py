"""Requests in bounded time. pymodbus renames its calls now and then: they are all here and in `client`."""

import logging
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace

from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU

from drivers.errors import DriveConnectionError, DriveStateError
from drivers.host_time import ATTEMPTS, no_answer
from drivers.modbus.blocks import Block, blocks
from drivers.modbus.register import Register, Space, Text
from drivers.modbus.register_map import WRITE_ONE, WRITE_SEVERAL
from drivers.modbus.settings import ModbusSettings

_READS = frozenset({1, 2, 3, 4, 23})  # answered with address, function, number of bytes, data, CRC
_SHORTEST_BYTES = 5  # an exception: address, function, code, CRC
_WRITE_BYTES = 8  # address, function, register, value or number, CRC
_REFUSED = 0x80
RESYNC_S = 0.005  # at least; more than 3.5 characters of silence: whoever listens starts anew
_REFUSALS = {
    1: "the drive does not know this function",
    2: "the drive has no such register, or not for this access",
    3: "the drive does not take this value",
    4: "the drive failed to do it",
    6: "the drive is busy",
    10: "the gateway has no way to the drive",
    11: "the drive does not answer its gateway",
}


class QuickSerialClient(ModbusSerialClient):
    """pymodbus' own client looks for bytes once a millisecond, twice for each answer.

    This one waits for whole answers.
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


class Link:
    """A connection to one drive.

    Raises:
        DriveConnectionError: the port is not there or in use, or nobody listens.
    """

    def __init__(self, settings: ModbusSettings, write_function: int | None = None) -> None:
        logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)  # what it logs is raised here
        self._settings, self._device = settings, settings.device
        self._unit, self._write_function = settings.unit, write_function
        self._resync_s = max(RESYNC_S, settings.line_silence_s)
        self._limit_s, self._deadline_s = ATTEMPTS * _longest_attempt_s(settings), 0.0
        self._client: ModbusSerialClient | ModbusTcpClient
        timeout_s = settings.answer_timeout_s
        if settings.transport == "rtu":
            self._client = QuickSerialClient(settings)
        else:
            self._client = ModbusTcpClient(settings.host, port=int(settings.port), timeout=timeout_s, retries=0)
        if not self._client.connect():
            self.close()
            hint = "is it plugged in, and not open elsewhere?" if settings.transport == "rtu" else "is the drive on?"
            raise DriveConnectionError(self._device, f"cannot be opened; {hint}")

    @staticmethod
    def longest_call_s(settings: ModbusSettings) -> float:
        """By then whoever has called `begin` has his answers, or an error [s]."""
        # an answer in pieces may take the limit twice
        return (ATTEMPTS + 1) * _longest_attempt_s(settings)

    def begin(self) -> None:
        """A call of the contract begins: from now on its requests share one time limit."""
        self._deadline_s = time.perf_counter() + self._limit_s

    def close(self) -> None:
        """Give the port back. Safe to call twice."""
        self._client.close()  # type: ignore[no-untyped-call]

    def read(self, block: Block) -> list[int]:
        """The words of a block.

        Raises:
            DriveConnectionError: no valid answer in time.
            DriveStateError: the drive refuses.
        """
        if block.space.is_bits:
            return self._read_bits(block)
        call = self._client.read_input_registers if block.space is Space.INPUT else self._client.read_holding_registers
        return self._words(block, lambda: call(block.address, count=block.words, device_id=self._unit))

    def write(self, block: Block, words: Sequence[int]) -> None:
        """Write the words of a block, by the function that the map names.

        Raises:
            DriveConnectionError, DriveStateError: as `read`.
        """
        client, unit, several = self._client, self._unit, len(words) > 1
        if several and self._write_function == WRITE_ONE:
            for place, word in enumerate(words):
                self.write(replace(block, address=block.address + place, words=1, registers=()), [word])
            return
        several = several or self._write_function == WRITE_SEVERAL
        if block.space.is_bits:
            bits = [bool(word) for word in words]
            if several:
                self._ask(block, lambda: client.write_coils(block.address, bits, device_id=unit))
            else:
                self._ask(block, lambda: client.write_coil(block.address, bits[0], device_id=unit))
        elif several:
            self._ask(block, lambda: client.write_registers(block.address, list(words), device_id=unit))
        else:
            self._ask(block, lambda: client.write_register(block.address, words[0], device_id=unit))

    def write_then_read(self, written: Block, words: Sequence[int], block: Block) -> list[int]:
        """Write one block and read another, in one request (function 23).

        Raises:
            DriveConnectionError, DriveStateError: as `read`.
        """
        return self._words(
            block,
            lambda: self._client.readwrite_registers(
                read_address=block.address, read_count=block.words, write_address=written.address,
                values=list(words), device_id=self._unit,
            ),
        )  # fmt: skip

    def read_one(self, register: Register) -> float:
        """The scaled value of one register.

        Raises:
            DriveConnectionError, DriveStateError: as `read`.
        """
        [block] = blocks([register])
        return block.decode(self.read(block))[register.name]

    def read_text(self, text: Text) -> str:
        """Its characters.

        Raises:
            DriveConnectionError, DriveStateError: as `read`.
        """
        return text.decode(self.read(Block(text.space, text.address, text.words, ())))

    def _read_bits(self, block: Block) -> list[int]:
        call = self._client.read_coils if block.space is Space.COIL else self._client.read_discrete_inputs
        answer = self._ask(block, lambda: call(block.address, count=block.words, device_id=self._unit))
        return [int(bit) for bit in answer.bits[: block.words]]

    def _words(self, block: Block, call: Callable[[], ModbusPDU]) -> list[int]:
        return list(self._ask(block, call, block.words).registers)

    def _ask(self, block: Block, call: Callable[[], ModbusPDU], words: int | None = None) -> ModbusPDU:
        """One request, asked again once where it was not answered, or with other than so many words.

        RTU does not number its requests: an answer of another length is one that came late, to a request before.
        """
        began_s, found = time.perf_counter(), "nothing"
        for _ in range(ATTEMPTS):
            try:
                answer = call()
            except (ModbusException, OSError) as error:
                found = _short(error)
                if not self._recover():
                    break
                continue
            if answer.isError():
                raise self._refused(answer, block)
            if words is None or len(answer.registers) == words:
                return answer
            found = f"{len(answer.registers)} of {words} words"
            if not self._recover():
                break
        raise self._no_answer(found, block, began_s)

    def _recover(self) -> bool:
        """Leave half an answer behind; False where the time is up."""
        if self._settings.transport == "tcp":
            self.close()  # the next request connects anew: an answer that comes late has nowhere to go
        with suppress(OSError):
            time.sleep(self._resync_s)
        return time.perf_counter() < self._deadline_s

    def _refused(self, answer: ModbusPDU, block: Block) -> DriveStateError:
        code = getattr(answer, "exception_code", 0)
        why = _REFUSALS.get(code, "an exception that the standard does not name")
        return DriveStateError(
            self._device,
            f"{_place(block)}: refused with exception {code}, {why}; compare the register map with its manual",
        )

    def _no_answer(self, found: str, block: Block, began_s: float) -> DriveConnectionError:
        timeout_s, check = self._settings.answer_timeout_s, f"the unit ({self._unit}) and the line's settings"
        rest_s = _longest_attempt_s(self._settings) - timeout_s
        return no_answer(self._device, f"{_place(block)}: found {found}", check, timeout_s, began_s, rest_s)


def _longest_attempt_s(settings: ModbusSettings) -> float:
    """Echo and answer, each of which may come in pieces, and the silence after half an answer [s]."""
    parts = 3.0 if settings.echo else 2.0
    return parts * settings.answer_timeout_s + max(RESYNC_S, settings.line_silence_s)


def _place(block: Block) -> str:
    names = ", ".join(register.name for register in block.registers)
    what = "bits" if block.space.is_bits else "registers"
    return f"{names} ({block.space.value} {what} {block.address} .. {block.address + block.words - 1})"


def _short(error: Exception) -> str:
    return "nothing" if "No response" in str(error) or "No Response" in str(error) else f"'{error}'"
