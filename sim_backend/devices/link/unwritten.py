"""Writing to a host that may not read: whole packets or none, and never waiting."""

from collections.abc import Callable


class Unwritten:
    """Keeps the rest of a packet of which a part was taken, and loses packets while that rest is not gone.

    Args:
        write: takes some of the bytes, and returns how many; raises `OSError` where it takes none.
    """

    def __init__(self, write: Callable[[bytes], int]) -> None:
        self._write = write
        self._rest = b""

    def put(self, packet: bytes) -> None:
        """Write a packet."""
        self._rest = self._after(self._rest)
        if not self._rest:
            self._rest = self._after(packet, whole=True)

    def _after(self, data: bytes, whole: bool = False) -> bytes:
        """Return what is left of some bytes after writing; nothing of a packet that found no room at all."""
        try:
            return data[self._write(data) :] if data else b""
        except OSError:
            return b"" if whole else data
