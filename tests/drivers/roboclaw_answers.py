"""A serial port with a RoboClaw's answers behind it, given as bytes; for tests of the driver alone.

Checksums are computed here bit by bit from the polynomial in the manual; nothing is shared with the driver.
"""

import serial

SIZES = {14: 5, 32: 6, 33: 6, 133: 12, 134: 12}  # of writes, with address, command and CRC; a read has 2 bytes
VERSION = b"USB Roboclaw 2x15a v4.1.34\n\0"


def crc(data):
    remainder = 0
    for byte in data:
        remainder ^= byte << 8
        for _ in range(8):
            remainder = (remainder << 1) ^ 0x1021 if remainder & 0x8000 else remainder << 1
            remainder &= 0xFFFF
    return remainder.to_bytes(2, "big")


class Answers:
    """What `serial.Serial` returns. `data` holds the answer to each read, by number; None is silence."""

    def __init__(self):
        self.data = {
            15: bytes([2]),
            16: bytes(5),
            17: bytes(5),
            18: bytes(5),
            19: bytes(5),
            21: VERSION,
            24: (240).to_bytes(2, "big"),
            48: bytes(4),
            49: bytes(4),
            82: (305).to_bytes(2, "big"),
            90: bytes(4),
            135: bytes(8),
            136: bytes(8),
        }
        self.sent = []
        self.corrupt = 0  # so many answers to come have a bit turned over
        self.duties = []
        self.keeps_timeout = self.keeps_limit = True
        self.buffered = True
        self.closed = True
        self._waiting = b""

    def __call__(self, port, baud_rate, **options):
        assert options["exclusive"]
        if port == "/dev/absent":
            raise serial.SerialException("could not open port /dev/absent: No such file or directory")
        self.closed = False
        return self

    def write(self, packet):
        """Take packets in a row; a controller without `buffered` hears the first of them."""
        self.sent.append(bytes(packet))
        answer, rest = b"", bytes(packet)
        while rest and (self.buffered or not answer):
            size = SIZES.get(rest[1], 2)
            answer += self._answer(rest[:size])
            rest = rest[size:]
        if self.corrupt and answer:
            self.corrupt -= 1
            answer = answer[:-1] + bytes([answer[-1] ^ 0x10])
        self._waiting += answer

    def _answer(self, packet):
        address, number = packet[:2]
        if address != 0x80:
            return b""
        if number in SIZES:
            if packet[-2:] != crc(packet[:-2]):
                return b""
            if number == 14 and self.keeps_timeout:
                self.data[15] = packet[2:3]
            elif number in (133, 134) and self.keeps_limit:
                self.data[number + 2] = packet[2:10]
            elif number in (32, 33):
                self.duties.append(int.from_bytes(packet[2:4], "big", signed=True))
            return b"\xff"
        data = self.data.get(number)
        return b"" if data is None else data + crc(packet + data)

    def read(self, size):
        taken, self._waiting = self._waiting[:size], self._waiting[size:]
        return taken

    @property
    def in_waiting(self):
        return len(self._waiting)

    def read_until(self, end, size):
        found = self._waiting.find(end)
        return self.read(min(size, found + len(end) if found >= 0 else size))

    def reset_input_buffer(self):
        self._waiting = b""

    def close(self):
        self.closed = True
