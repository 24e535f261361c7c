"""A pseudo-terminal that looks like a serial port."""

import contextlib
import os
import pty
import select
import tty
from collections.abc import Callable
from pathlib import Path


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


class PseudoTerminal:
    """The device's end of a pseudo-terminal; hosts open `path`.

    Args:
        link: a symbolic link to put on the host's end, so that the name stays when the port comes back; None: none.
    """

    def __init__(self, link: Path | None = None) -> None:
        self._link = link
        self._ours, self._theirs = pty.openpty()
        tty.setraw(self._theirs)
        os.set_blocking(self._ours, False)
        name = os.ttyname(self._theirs)
        if link is not None:
            link.unlink(missing_ok=True)
            link.symlink_to(name)
        self.path = str(link or name)
        self._unwritten = Unwritten(lambda data: os.write(self._ours, data))

    def read(self, timeout_s: float) -> bytes:
        """Return what the host has written, after waiting for it no longer than this; b'' for nothing.

        Their end is kept open here, so a host that goes is silence, not an error.
        """
        ready, _, _ = select.select([self._ours], [], [], timeout_s)
        return os.read(self._ours, 4096) if ready else b""

    def write(self, data: bytes) -> None:
        """Write without waiting; what a host that does not read has no room for is lost, as on a wire."""
        self._unwritten.put(data)

    def close(self) -> None:
        """Close both ends. A host that has it open gets an error at its next read."""
        if self._link is not None:
            self._link.unlink(missing_ok=True)
        for descriptor in (self._ours, self._theirs):
            with contextlib.suppress(OSError):
                os.close(descriptor)
