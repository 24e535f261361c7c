"""A CAN frame with an 11-bit identifier."""

from typing import NamedTuple


class Frame(NamedTuple):
    """One frame.

    Attributes:
        can_id: identifier, 0 .. 0x7FF.
        data: at most eight bytes.
        remote: a remote request.
    """

    can_id: int
    data: bytes = b""
    remote: bool = False
