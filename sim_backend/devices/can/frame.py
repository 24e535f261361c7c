"""A CAN frame, and who takes one: a device on the bus, an adapter between the bus and a host."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

from sim_backend.devices.axis import Device


class Frame(NamedTuple):
    """One frame.

    Attributes:
        can_id: identifier.
        data: at most eight bytes.
        remote: a remote request.
        extended: its identifier has 29 bits, else 11.
        fd: a frame of CAN-FD, of up to 64 bytes.
    """

    can_id: int
    data: bytes = b""
    remote: bool = False
    extended: bool = False
    fd: bool = False


class CanNode(Protocol):
    """The device's place on the bus.

    Attributes:
        send: takes the frames that go out; set by whoever has the bus.
    """

    send: Callable[[Frame], None]

    def boot(self) -> None:
        """The bus is there: say what is to be said at power-up."""


class QuietNode:
    """The place on the bus of a device that says nothing at power-up."""

    def __init__(self) -> None:
        self.send: Callable[[Frame], None] = lambda _frame: None

    def boot(self) -> None:
        """Nothing is to be said."""


class CanDevice(Device, Protocol):
    """A device with a node."""

    @property
    def node(self) -> CanNode:
        """Its place on the bus."""

    def receive(self, frame: Frame, time_s: float) -> None:
        """Take a frame at a time [s]; answers go out through `node.send`."""


class Adapter(Protocol):
    """The adapter's side of a text protocol."""

    def greet(self) -> bytes:
        """Return what it says to whoever connects."""

    def feed(self, data: bytes) -> tuple[bytes, list[Frame]]:
        """Take bytes of the host; return the answer, and the frames to put on the bus."""

    def tell(self, frame: Frame) -> bytes:
        """Return what it says of a frame on the bus; b'' while it is closed."""
