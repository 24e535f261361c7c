"""Cyclic synchronous torque (10): the host says the torque of every cycle."""

from sim_backend.devices.canopen.dictionary import Dictionary
from sim_backend.devices.canopen.modes.mode import FOLLOWS, Mode, Seen


class CyclicTorque(Mode):
    """Target torque (0x6071) plus torque offset (0x60B2)."""

    def __init__(self, dictionary: Dictionary) -> None:
        self._dictionary = dictionary

    def start(self, seen: Seen) -> None:
        """Nothing to begin with."""

    def torque(self, seen: Seen) -> float:  # noqa: ARG002
        """Return the torque [permille]."""
        return self._dictionary.number(0x6071) + self._dictionary.number(0x60B2)

    def status(self) -> int:
        """The drive follows."""
        return FOLLOWS
