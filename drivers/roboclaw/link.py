"""The serial port: one question, one answer, in bounded time.

A write is `address, command, data, CRC` and answered with 0xFF, or not at all where the CRC is wrong. A read is
`address, command`, without CRC, and answered with `data, CRC`; that CRC is over address, command and data. The CRC is
CRC-16/XMODEM (polynomial 0x1021, start 0, neither reflected nor inverted), high byte first.
"""

import time
from binascii import crc_hqx

from drivers.errors import DriveConnectionError
from drivers.host_time import ATTEMPTS, no_answer
from drivers.roboclaw.commands import ACKNOWLEDGED, CRC_BYTES, LONGEST_VERSION_BYTES, READ_VERSION, Read, Write
from drivers.roboclaw.settings import RoboclawSettings
from drivers.serial_port import SerialPort

VERSION_END = b"\n\0"
RESYNC_S = 0.012  # the controller forgets half a packet after 10 ms of silence


def crc16(data: bytes) -> int:
    """CRC-16/XMODEM; of b"123456789" it is 0x31C3."""
    return crc_hqx(data, 0)


def write_packet(address: int, command: Write, *values: int) -> bytes:
    """The bytes of a write.

    Args:
        address: 0x80 .. 0x87.
        command: from the table.
        values: as its layout wants them.
    """
    packet = bytes((address, command.number)) + command.layout.pack(*values)
    return packet + crc16(packet).to_bytes(2, "big")


def read_packet(address: int, command: Read) -> bytes:
    """The bytes of a read."""
    return bytes((address, command.number))


def version_packet(address: int) -> bytes:
    """The bytes that ask for the firmware version."""
    return bytes((address, READ_VERSION))


def is_intact(request_crc: int, reply: bytes) -> bool:
    """Whether the CRC at the end of a reply to a read is right."""
    # of data followed by its own CRC, the CRC is 0
    return len(reply) > CRC_BYTES and crc_hqx(reply, request_crc) == 0


class Link:
    """An open port to one controller.

    Raises:
        DriveConnectionError: the port is not there, or somebody else uses it.
    """

    def __init__(self, settings: RoboclawSettings, device: str) -> None:
        self._device = device
        self._address = settings.address
        self._timeout_s = settings.answer_timeout_s
        self._requests: dict[int, tuple[bytes, int]] = {}
        self._deadline_s = 0.0
        self._port = SerialPort(device, settings.port, settings.baud_rate, settings.answer_timeout_s)

    @staticmethod
    def longest_call_s(settings: RoboclawSettings) -> float:
        """By then whoever has called `begin` has his answers, or an error [s]."""
        return (ATTEMPTS + 1) * (settings.answer_timeout_s + RESYNC_S)

    def begin(self) -> None:
        """A call of the contract begins: from now on its questions share one time limit."""
        self._deadline_s = time.perf_counter() + ATTEMPTS * (self._timeout_s + RESYNC_S)

    def close(self) -> None:
        """Give the port back. Safe to call twice."""
        self._port.close()

    def read(self, command: Read) -> tuple[int, ...]:
        """Ask, and return the data of the answer.

        Raises:
            DriveConnectionError: no intact answer in time, or the port is gone.
        """
        request, request_crc = self._request(command)
        size = command.reply_bytes
        began_s, found = time.perf_counter(), "nothing"
        for _ in range(ATTEMPTS):
            reply = self._port.ask(request, size)
            if len(reply) == size and is_intact(request_crc, reply):
                return command.layout.unpack_from(reply)
            found = _seen(reply, size)
            if not self._resync():
                break
        raise self._no_answer(command.meaning, found, began_s)

    def write(self, command: Write, *values: int) -> None:
        """Tell, and wait for the acknowledgement. Told twice where the first was not acknowledged.

        Raises:
            DriveConnectionError: not acknowledged in time, or the port is gone.
        """
        packet = write_packet(self._address, command, *values)
        began_s, found = time.perf_counter(), "nothing"
        for _ in range(ATTEMPTS):
            reply = self._port.ask(packet, 1)
            if reply == ACKNOWLEDGED:
                return
            found = f"{reply.hex()} instead of ff" if reply else "nothing"
            if not self._resync():
                break
        raise self._no_answer(command.meaning, found, began_s)

    def together(self, command: Write, value: int, reads: tuple[Read, ...]) -> list[tuple[int, ...]] | None:
        """Tell and ask in one write. Returns the data of each answer; None where not every one was intact.

        Raises:
            DriveConnectionError: the port is gone.
        """
        packets = [write_packet(self._address, command, value)]
        packets += [self._request(read)[0] for read in reads]
        size = len(ACKNOWLEDGED) + sum(read.reply_bytes for read in reads)
        reply = self._port.ask(b"".join(packets), size)
        found = self._apart(reply, reads) if len(reply) == size and reply.startswith(ACKNOWLEDGED) else None
        if found is None:
            self._resync()
        return found

    def shout(self, command: Write, *values: int) -> None:
        """Tell once, and do not wait for the acknowledgement. Never raises."""
        self._port.shout(write_packet(self._address, command, *values))

    def version(self) -> str:
        """The text of command 21.

        Raises:
            DriveConnectionError: no intact answer in time, or the port is gone.
        """
        request = version_packet(self._address)
        began_s, found = time.perf_counter(), "nothing"
        for _ in range(ATTEMPTS):
            reply = self._ask_text(request)
            if is_intact(crc16(request), reply):
                return reply[: -CRC_BYTES - len(VERSION_END)].decode("ascii", "replace")
            found = "nothing" if not reply else f"{len(reply)} bytes that are no answer of a RoboClaw"
            if not self._resync():
                break
        raise self._no_answer("firmware version", found, began_s)

    def _request(self, command: Read) -> tuple[bytes, int]:
        """The packet of a question, and its CRC; made once."""
        prepared = self._requests.get(command.number)
        if prepared is None:
            packet = read_packet(self._address, command)
            prepared = self._requests[command.number] = packet, crc16(packet)
        return prepared

    def _apart(self, reply: bytes, reads: tuple[Read, ...]) -> list[tuple[int, ...]] | None:
        """The data of each answer in a row of them, the acknowledgement first; None where one is not intact."""
        found, start = [], len(ACKNOWLEDGED)
        for read in reads:
            answer = reply[start : start + read.reply_bytes]
            if not is_intact(self._request(read)[1], answer):
                return None
            found.append(read.layout.unpack_from(answer))
            start += read.reply_bytes
        return found

    def _ask_text(self, request: bytes) -> bytes:
        self._port.ask(request, 0)
        text = self._port.read_until(VERSION_END, LONGEST_VERSION_BYTES)
        return text + self._port.read(CRC_BYTES) if text.endswith(VERSION_END) else text

    def _resync(self) -> bool:
        """Let the controller forget half a packet, and forget half an answer; False where the time is up."""
        self._port.rest(RESYNC_S)
        return time.perf_counter() < self._deadline_s

    def _no_answer(self, meaning: str, found: str, began_s: float) -> DriveConnectionError:
        check = f"the address ({self._address:#x}) and the baud rate"
        return no_answer(self._device, f"{meaning}: found {found}", check, self._timeout_s, began_s, RESYNC_S)


def _seen(reply: bytes, wanted_bytes: int) -> str:
    if not reply:
        return "nothing"
    if len(reply) < wanted_bytes:
        return f"{len(reply)} of {wanted_bytes} bytes"
    return "an answer with a wrong CRC"
