"""A CAN frame."""

from typing import NamedTuple


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
