"""The file of an SQLite store: how it may be opened, and whether it is still the one that was opened."""

import os
import sqlite3
from pathlib import Path
from urllib.parse import quote

from bench.store.errors import StoreFileError

_EFFECTIVE = os.access in os.supports_effective_ids


class SqliteFile:
    """A database file and its log.

    Args:
        path: of the database, absolute; it need not be there yet.

    Attributes:
        is_read_only: the file or its folder may not be written: it is read as it is, and nothing is made beside it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.is_read_only = path.exists() and not (_may_write(path) and _may_write(path.parent))
        self._inode: int | None = None

    @property
    def log(self) -> Path:
        """Where SQLite keeps what was committed and is not yet in the file."""
        return self.path.with_name(f"{self.path.name}-wal")

    def connect(self, busy_timeout_s: float) -> sqlite3.Connection:
        """A connection; the file is made by the first one alone.

        Args:
            busy_timeout_s: how long a statement waits for a lock of another connection [s].

        Raises:
            StoreFileError: it was taken away since.
            sqlite3.Error: as SQLite says it.
        """
        self.require()
        address = f"file:{quote(str(self.path))}?mode={self._mode()}"
        # the lock must be waited for from the first statement on
        made = sqlite3.connect(address, uri=True, timeout=busy_timeout_s, check_same_thread=False)
        self._inode = self._inode or self._found()
        return made

    def require(self) -> None:
        """Refuse to go on with a file that is not there any more, or with another one in its place.

        SQLite would go on: it would write rows that nobody finds again, and read of a file that is empty.

        Raises:
            StoreFileError: with the next step.
        """
        if self._inode is not None and self._found() != self._inode:
            raise StoreFileError(
                f"store '{self.path}' was deleted, moved or replaced while it was in use; nothing more can be kept or "
                "read. Put the file back if you can, and start this program again"
            )

    def _mode(self) -> str:
        if not self.is_read_only:
            return "rwc" if self._inode is None else "rw"
        # without a log nothing can change it, and SQLite needs no file beside it to tell other programs so
        has_log = self.log.exists() and self.log.stat().st_size > 0
        return "ro" if has_log else "ro&immutable=1"

    def _found(self) -> int | None:
        try:
            return self.path.stat().st_ino
        except (FileNotFoundError, NotADirectoryError):
            return None


def _may_write(path: Path) -> bool:
    return os.access(path, os.W_OK, effective_ids=_EFFECTIVE)
