"""A CAN adapter that a host reaches over a byte stream."""

from typing import Protocol

from sim_backend.devices.can.frame import Frame


class Adapter(Protocol):
    """The adapter's side of a text protocol."""

    def greet(self) -> bytes:
        """Return what it says to whoever connects."""

    def feed(self, data: bytes) -> tuple[bytes, list[Frame]]:
        """Take bytes of the host; return the answer, and the frames to put on the bus."""

    def tell(self, frame: Frame) -> bytes:
        """Return what it says of a frame on the bus; b'' while it is closed."""
