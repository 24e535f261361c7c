"""What a bus asks of a protocol: packets made and taken apart. Pure."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple


class Item(NamedTuple):
    """One item of a servo's table: where it is, and how long, low byte first."""

    address: int
    size: int
    name: str


def error_names(word: int, names: dict[int, str]) -> str:
    """The bits of an error by the names of the manual; "" for none."""
    return ", ".join(f"{names.get(bit, f'bit {bit}')} error" for bit in range(8) if word & 1 << bit)


class StatusPacket(NamedTuple):
    """What a servo answers."""

    servo_id: int
    error: int
    data: bytes


@dataclass(frozen=True, slots=True)
class Frames:
    """A protocol.

    Attributes:
        status_bytes: of an answer without parameters.
        read: asks one servo for bytes: id, address, number.
        write: writes into the table of one servo: id, address, bytes.
        sync_read: asks several servos for the same bytes: ids, address, number.
        sync_write: writes into the same place of several servos: bytes by id, address.
        packet_bytes: length of the packet that begins so; 0 where it is no packet.
        status: takes a whole answer apart; None where it is not intact.
        refusal: what an error byte refuses, in words; "" for nothing.
        ping: asks whether a servo is there; with the broadcast id, everybody.
        broadcast: the id of everybody.
        nobody_answers: whether the last packet of some bytes is one that no servo answers.
    """

    status_bytes: int
    read: Callable[[int, int, int], bytes]
    write: Callable[[int, int, bytes], bytes]
    sync_read: Callable[[tuple[int, ...], int, int], bytes]
    sync_write: Callable[[dict[int, bytes], int], bytes]
    packet_bytes: Callable[[bytes], int]
    status: Callable[[bytes], StatusPacket | None]
    refusal: Callable[[int], str]
    ping: Callable[[int], bytes]
    broadcast: int
    nobody_answers: Callable[[bytes], bool]
