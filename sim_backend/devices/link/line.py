"""A byte line with a baud rate and faults: which bytes arrive when."""

import random
import time
from typing import NamedTuple

from sim_backend.devices.link.faults import Direction, LinkFaultKind, LinkFaults
from sim_backend.devices.wall_time import WallTime

BITS_PER_BYTE = 10  # 8N1: start, eight data, stop


class Delivery(NamedTuple):
    """Bytes that arrive at a time [s]."""

    at_s: float
    data: bytes


class Line:
    """What becomes of packets on a line, either way. It reads no clock and moves no byte itself.

    Args:
        baud: bits a second; None is as fast as the machine.
        faults: what goes wrong; may be added to at any time.
        seed: of the chance in faults.
    """

    def __init__(self, baud: int | None = None, faults: LinkFaults | None = None, seed: int = 0) -> None:
        self.faults = faults or LinkFaults()
        self._byte_s = BITS_PER_BYTE / baud if baud else 0.0
        self._free_s = dict.fromkeys(Direction, 0.0)
        self._random = random.Random(seed)  # noqa: S311  (no secret)

    def carry(self, direction: Direction, data: bytes, now_s: float) -> list[Delivery]:
        """Return what arrives of a packet that is sent now, in order."""
        if self.faults.holds(LinkFaultKind.SILENT, now_s):
            return []
        fault = self.faults.strike(direction, now_s, self._random.random())
        if fault is None:
            return [self._paced(direction, data, now_s)]
        match fault.kind:
            case LinkFaultKind.DELAY:
                return [self._paced(direction, data, now_s + fault.amount_s)]
            case LinkFaultKind.CORRUPT:
                return [self._paced(direction, self._flipped(data), now_s)]
            case LinkFaultKind.DUPLICATE:
                return [self._paced(direction, data, now_s), self._paced(direction, data, now_s)]
            case LinkFaultKind.SPLIT:
                half = max(len(data) // 2, 1)
                first = self._paced(direction, data[:half], now_s)
                second = self._paced(direction, data[half:], first.at_s + fault.amount_s)
                return [first, second] if second.data else [first]
        return []  # dropped, or the port is gone

    def _paced(self, direction: Direction, data: bytes, now_s: float) -> Delivery:
        at_s = max(now_s, self._free_s[direction]) + len(data) * self._byte_s
        self._free_s[direction] = at_s
        return Delivery(at_s, data)

    def _flipped(self, data: bytes) -> bytes:
        place = self._random.randrange(len(data))
        flipped = bytearray(data)
        flipped[place] ^= 1 << self._random.randrange(8)
        return bytes(flipped)


_SPIN_S = 2e-4  # a nap on a busy machine ends late by about this much


def pause_until(clock: WallTime, at_s: float) -> None:
    """Return at a time [s] of the clock, or at once where that is over."""
    left_s = at_s - clock.now_s()
    if left_s > _SPIN_S:
        time.sleep(left_s - _SPIN_S)
    while clock.now_s() < at_s:
        pass
