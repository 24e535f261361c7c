"""What every simulated device offers to the threads around it."""

from threading import RLock
from typing import Protocol

from sim_backend.devices.axis import Axis


class Device(Protocol):
    """A drive's protocol and real-time half on an axis. It reads no clock; whoever calls says what time it is.

    Attributes:
        axis: the power stage and the joint.
        lock: held by every thread while it calls.
    """

    axis: Axis
    lock: RLock

    def advance_to(self, time_s: float) -> None:
        """Let time pass up to a time [s] of the axis."""

    def report(self) -> dict[str, object]:
        """What the drive is about, for the side channel: its state, its watchdog, its fault."""
