"""What changes slowly and cannot be put into a PDO: one SDO upload at a time, between the cycles. Pure.

CiA 301, 7.2.4.3. The request goes out after a cycle, the answer comes in with the frames of a later one: no cycle
waits for it.
"""

import struct
from typing import Final, NamedTuple

from drivers.canopen.cia301.objects import DriveObject

_REQUEST: Final = struct.Struct("<BHB4x")
_ANSWER: Final = struct.Struct("<BHB4s")
_UPLOAD: Final = 0x40
_EXPEDITED: Final = 0x42
_ABORT: Final = 0x80


class Reading(NamedTuple):
    """A value [counts], and when it came in [s]."""

    value: int
    time_s: float


class SlowPoll:
    """Asks for some objects in turn.

    Args:
        items: what to ask for.
        interval_s: how often for each [s].
        lost_s: an answer that takes longer does not come [s].
    """

    def __init__(self, items: tuple[DriveObject, ...], interval_s: float, lost_s: float = 0.2) -> None:
        self.readings: dict[DriveObject, Reading] = {}
        self._items = items
        self._lost_s = lost_s
        self._interval_s = interval_s / max(len(items), 1)
        self._next = 0
        self._asked: DriveObject | None = None
        self._asked_s = float("-inf")

    def put(self, item: DriveObject, value: int, time_s: float) -> None:
        """Keep a value that was read otherwise."""
        self.readings[item] = Reading(value, time_s)

    def awaits(self, now_s: float) -> bool:
        """Whether an answer may still come."""
        return self._asked is not None and now_s - self._asked_s < self._lost_s

    def request(self, now_s: float) -> bytes | None:
        """The request to send now, if one is due and none is under way."""
        since_s = now_s - self._asked_s
        if not self._items or since_s < self._interval_s or self.awaits(now_s):
            return None
        item = self._items[self._next]
        self._next = (self._next + 1) % len(self._items)
        self._asked, self._asked_s = item, now_s
        return _REQUEST.pack(_UPLOAD, item.index, item.subindex)

    def take(self, data: bytes, now_s: float) -> bool:
        """Look at an SDO answer; tell whether it was for this poll."""
        item = self._asked
        if item is None or len(data) != _ANSWER.size:
            return False
        command, index, subindex, payload = _ANSWER.unpack(data)
        if (index, subindex) != (item.index, item.subindex) or not (command == _ABORT or command & 0xE2 == _EXPEDITED):
            return False
        self._asked = None
        if command != _ABORT:
            self.readings[item] = Reading(item.unpack(payload), now_s)
        return True
