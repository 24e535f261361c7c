"""Heartbeats: the node's own, and the watch over others'."""

from functools import partial

from sim_backend.devices.canopen.abort import Abort, AbortCode
from sim_backend.devices.canopen.dictionary import Dictionary


class HeartbeatProducer:
    """Says when the node's own heartbeat is due (0x1017, ms)."""

    def __init__(self, dictionary: Dictionary) -> None:
        self._dictionary = dictionary
        self._next_s: float | None = None
        self._period_s = 0.0

    def is_due(self, time_s: float) -> bool:
        """Tell, once for each."""
        period_s = self._dictionary.number(0x1017) * 1e-3
        if period_s != self._period_s:
            self._period_s = period_s
            self._next_s = time_s if period_s else None
        if self._next_s is None or time_s < self._next_s - 1e-9:
            return False
        self._next_s += self._period_s
        return True


class HeartbeatConsumer:
    """Watches other nodes (0x1016: node << 16 | ms). The watch over a node begins with its first heartbeat.

    Args:
        dictionary: the node's.
        deaf: it takes what is written to 0x1016, and never watches.
    """

    def __init__(self, dictionary: Dictionary, deaf: bool = False) -> None:
        self._dictionary = dictionary
        self._deaf = deaf
        self._numbers = dictionary.subindices(0x1016)
        self._heard_s: dict[int, float] = {}  # by node
        self._lost: set[int] = set()
        for number in self._numbers:
            dictionary.checks[0x1016, number] = partial(self._check, number)
            dictionary.reactions[0x1016, number] = self.reset

    def reset(self) -> None:
        """Begin anew: wait for each node's first heartbeat."""
        self._heard_s.clear()
        self._lost.clear()

    @property
    def has_lost(self) -> bool:
        """Whether a node is missing now."""
        return bool(self._lost)

    def hear(self, node_id: int, time_s: float) -> bool:
        """Take a heartbeat; tell whether that brings back the last node that was missing."""
        if node_id not in self._watched():
            return False
        self._heard_s[node_id] = time_s
        was_lost = node_id in self._lost
        self._lost.discard(node_id)
        return was_lost and not self._lost

    def loses(self, time_s: float) -> bool:
        """Tell whether a node has just gone missing, once for each."""
        if not self._heard_s:
            return False
        watched = self._watched()
        gone = {
            node_id
            for node_id, heard_s in self._heard_s.items()
            if node_id not in self._lost and time_s - heard_s > watched[node_id]
        }
        self._lost |= gone
        return bool(gone)

    def _watched(self, without: int = 0) -> dict[int, float]:
        numbers = [] if self._deaf else [number for number in self._numbers if number != without]
        entries = [self._dictionary.number(0x1016, number) for number in numbers]
        return {_node_id(entry): (entry & 0xFFFF) * 1e-3 for entry in entries if _watches(entry)}

    def _check(self, number: int, value: int) -> None:
        if _watches(value) and _node_id(value) in self._watched(without=number):
            raise Abort(AbortCode.PARAMETER_INCOMPATIBLE)


def _node_id(entry: int) -> int:
    return entry >> 16 & 0xFF


def _watches(entry: int) -> bool:
    return entry & 0xFFFF != 0 and 1 <= _node_id(entry) <= 127
