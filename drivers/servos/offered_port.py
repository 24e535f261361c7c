"""A pseudo-terminal that another program opens in the place of a serial port."""

import os
import pty
import tty
from contextlib import suppress
from pathlib import Path

from drivers.errors import DriveConnectionError

_MOST_BYTES = 4096


class OfferedPort:
    """Our end of it.

    Args:
        link: a name for the other end, so that it can be written into that program's settings.

    Raises:
        DriveConnectionError: something that is no link of ours has the name.
    """

    def __init__(self, link: Path) -> None:
        if link.exists() and not link.is_symlink():
            raise DriveConnectionError(str(link), "is there already, and is no link; offer the port by another name")
        self._link = link
        self._ours, self._theirs = pty.openpty()  # their end stays open here: who goes is silent, and no error
        tty.setraw(self._theirs)
        os.set_blocking(self._ours, False)
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._theirs))

    def fileno(self) -> int:
        """For `select`."""
        return self._ours

    def take(self) -> bytes:
        """What the other program has written."""
        try:
            return os.read(self._ours, _MOST_BYTES)
        except BlockingIOError:
            return b""

    def give(self, data: bytes) -> None:
        """Let the other program read something; what it has no room for is lost, as on a wire."""
        with suppress(BlockingIOError):
            os.write(self._ours, data)

    def close(self) -> None:
        """Take it away. Safe to call twice."""
        self._link.unlink(missing_ok=True)
        for descriptor in (self._ours, self._theirs):
            with suppress(OSError):
                os.close(descriptor)
