"""What the drive's heartbeats, or its answers to node guarding, tell (CiA 301, 7.2.8.2). Pure."""

from enum import IntEnum


class NmtState(IntEnum):
    """What a heartbeat says."""

    BOOT_UP = 0x00
    STOPPED = 0x04
    OPERATIONAL = 0x05
    PRE_OPERATIONAL = 0x7F


class DriveMonitor:
    """What the drive's heartbeat tells.

    Args:
        timeout_s: silence after which the drive counts as gone [s].
    """

    def __init__(self, timeout_s: float) -> None:
        self.timeout_s = timeout_s
        self.state: NmtState | None = None
        self.restarted = False
        self._heard_s = 0.0
        self._watched_s = 0.0

    def hear(self, data: bytes, now_s: float) -> None:
        """A heartbeat came in.

        Raises:
            ValueError: it has not one byte, or its state is none.
        """
        if len(data) != 1:
            raise ValueError(f"a heartbeat has 1 byte, not {len(data)}")
        # bit 7 is the toggle bit of node guarding
        self.state = NmtState(data[0] & 0x7F)
        self.restarted = self.restarted or self.state is NmtState.BOOT_UP
        self._heard_s = now_s

    def begin(self, now_s: float) -> None:
        """Expect it from now on."""
        self._heard_s = self._watched_s = now_s

    def silence_s(self, now_s: float) -> float:
        """How long it has been silent while somebody listened [s]."""
        if now_s - self._watched_s > self.timeout_s:
            self._heard_s = now_s  # nobody has listened: it starts anew
        self._watched_s = now_s
        return now_s - self._heard_s
