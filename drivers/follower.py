"""A joint that another program moves: it is looked at, and never told anything."""

from typing import Protocol

from drivers.contract import Sample


class Follower(Protocol):
    """Looks at a joint in the pauses of another program.

    Attributes:
        place: what that program opens in the place of the real port.
        device: name used in messages.
        product: what answers.
    """

    place: str
    device: str
    product: str

    def look(self, timeout_s: float) -> Sample | None:
        """Pass on what is said for a while [s]; return a sample as soon as one was taken, else None.

        Raises:
            DriveConnectionError: the real port is gone.
        """

    @property
    def silent_s(self) -> float:
        """How long the other program has said nothing [s]."""

    def close(self) -> None:
        """Give both ports back. Never raises."""
