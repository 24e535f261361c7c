"""How a node notices without heartbeats that its host is gone: life guarding, event timer of RPDOs (CiA 301)."""

from sim_backend.devices.canopen.dictionary import Dictionary

_TOGGLE = 0x80


class LifeGuard:
    """Answers the host's remote requests, and misses them after guard time x life time factor (0x100C, 0x100D).

    Args:
        dictionary: the node's.
        deaf: it answers, and never misses them.
    """

    def __init__(self, dictionary: Dictionary, deaf: bool = False) -> None:
        self._dictionary = dictionary
        self._deaf = deaf
        for index in (0x100C, 0x100D):
            dictionary.reactions[index, 0] = self.reset
        self.reset()

    def reset(self) -> None:
        """Begin anew: wait for the first request."""
        self._toggle = 0
        self._asked_s: float | None = None
        self.has_lost = False

    def answer(self, state: int, time_s: float) -> tuple[bytes, bool]:
        """Return the answer to a request, and whether the host was missing until then."""
        was_lost, self.has_lost = self.has_lost, False
        self._asked_s = time_s
        data = bytes([self._toggle | state])
        self._toggle ^= _TOGGLE
        return data, was_lost

    def loses(self, time_s: float) -> bool:
        """Tell whether the host has just gone missing, once."""
        if self._deaf or self._asked_s is None or self.has_lost:
            return False
        life_s = self._dictionary.number(0x100C) * self._dictionary.number(0x100D) * 1e-3
        self.has_lost = bool(life_s) and time_s - self._asked_s > life_s
        return self.has_lost


class Deadline:
    """Event timer of one RPDO (subindex 5 of its communication parameter, ms): counts from the first that comes.

    Args:
        dictionary: the node's.
        link: index of the communication parameter.
        deaf: it never counts.
    """

    def __init__(self, dictionary: Dictionary, link: int, deaf: bool = False) -> None:
        self._dictionary = dictionary
        self._link = link
        self._deaf = deaf or (link, 5) not in dictionary
        if not self._deaf:
            dictionary.reactions[link, 5] = self.reset
        self.reset()

    def reset(self) -> None:
        """Begin anew: wait for the first RPDO."""
        self._heard_s: float | None = None

    def hear(self, time_s: float) -> None:
        """It has come."""
        self._heard_s = time_s

    def passes(self, time_s: float) -> bool:
        """Tell whether it has just passed, once."""
        if self._deaf or self._heard_s is None:
            return False
        limit_s = self._dictionary.number(self._link, 5) * 1e-3
        if not limit_s or time_s - self._heard_s <= limit_s:
            return False
        self._heard_s = None
        return True
