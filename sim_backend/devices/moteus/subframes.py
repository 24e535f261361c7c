"""Subframes of the register protocol: what a host writes and reads, and what is replied."""

from collections.abc import Iterator
from math import isnan, nan
from struct import error, pack, unpack_from
from typing import NamedTuple

NOTHING = 0x50
TO_CONSOLE, FROM_CONSOLE, POLL_CONSOLE = 0x40, 0x41, 0x42
_TYPES = "bhif"
_SIZES = (1, 2, 4, 4)
FLOAT = 3
Scale = tuple[float, float, float]
_UNSET = (-0x80, -0x8000, -0x8000_0000)
_TOP = (0x7F, 0x7FFF, 0x7FFF_FFFF)


class Write(NamedTuple):
    """Words that were written: kind 0 .. 3 (int8, int16, int32, float)."""

    kind: int
    register: int
    value: float


class Read(NamedTuple):
    """Registers that are asked for."""

    kind: int
    register: int
    many: int


class Console(NamedTuple):
    """Text to its console, or a question for what it says."""

    is_poll: bool
    text: bytes
    most: int


def apart(data: bytes) -> Iterator[Write | Read | Console]:
    """Yield the subframes of a frame; what cannot be read ends them."""
    place = 0
    try:
        while place < len(data):
            head = data[place]
            place += 1
            if head == NOTHING:
                continue
            if head < 0x20:
                kind, count = head >> 2 & 3, head & 3
                if not count:
                    count, place = _number(data, place)
                start, place = _number(data, place)
                if head >= 0x10:
                    yield Read(kind, start, count)
                    continue
                for register in range(start, start + count):
                    yield Write(kind, register, unpack_from("<" + _TYPES[kind], data, place)[0])
                    place += _SIZES[kind]
            elif head == TO_CONSOLE:
                _, place = _number(data, place)
                length, place = _number(data, place)
                yield Console(False, data[place : place + length], 0)
                place += length
            elif head == POLL_CONSOLE:
                _, place = _number(data, place)
                most, place = _number(data, place)
                yield Console(True, b"", most)
            else:
                return
    except (IndexError, error):
        return


def in_si(write: Write, scale: Scale) -> float:
    """Return a written value; NaN for the largest negative number."""
    if write.kind == FLOAT:
        return write.value
    return nan if write.value == _UNSET[write.kind] else write.value * scale[write.kind]


def reply(read: Read, values: list[tuple[float, Scale]]) -> bytes:
    """Return the subframe that answers."""
    head = bytes((0x20 | read.kind << 2, read.many)) if read.many > 3 else bytes((0x20 | read.kind << 2 | read.many,))
    words = b"".join(_word(read.kind, value, scale) for value, scale in values)
    return head + _varuint(read.register) + words


def console_reply(text: bytes) -> bytes:
    """Return the subframe of what its console says."""
    return bytes((FROM_CONSOLE, 1, len(text))) + text


def _word(kind: int, value: float, scale: Scale) -> bytes:
    if kind == FLOAT:
        return pack("<f", value)
    word = _UNSET[kind] if isnan(value) else max(-_TOP[kind], min(_TOP[kind], round(value / scale[kind])))
    return pack("<" + _TYPES[kind], word)


def _number(data: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[place]
        place += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, place


def _varuint(value: int) -> bytes:
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes((*out, value))
