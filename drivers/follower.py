"""A joint that another program moves: it is looked at, and never told anything."""

from typing import Protocol

from drivers.contract import Sample


class Follower(Protocol):
    """Looks at a joint in the pauses of another program.

    Attributes:
        wanted: what that program has to do, after "let the other program".
        is_between: whether what that program says goes through here; else the bus is shared.
    """

    wanted: str
    device: str
    product: str
    is_between: bool

    def look(self, timeout_s: float) -> Sample | None:
        """Listen for a while [s], and pass on what is said; return a sample as soon as one was taken, else None.

        Raises:
            DriveConnectionError: the real port is gone.
        """

    @property
    def silent_s(self) -> float:
        """How long the other program, or on a bus the actuator, has said nothing [s]."""

    def close(self) -> None:
        """Give both ports back. Never raises."""
