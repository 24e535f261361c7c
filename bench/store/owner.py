"""Who runs an experiment, and whether that process still lives.

A process that runs experiments keeps a small file beside the database locked. The operating system
lets go of the lock when the process ends, however it ends, and a process id that was given away
again cannot be mistaken for it. The file is made and removed inside a transaction that writes, so
two processes never do so at once.
"""

import fcntl
import os
import uuid
from pathlib import Path

from bench.store.errors import StoreReadOnlyError


class Owner:
    """A claim: held until `release`, or until the process is gone.

    Args:
        database: path of the database file.

    Raises:
        StoreReadOnlyError: no file can be made beside the database.
    """

    def __init__(self, database: Path) -> None:
        self.token = f"{os.getpid()}-{uuid.uuid4().hex[:12]}"
        self._path = _lock_path(database, self.token)
        try:
            self._file = self._path.open("w")
        except OSError as error:
            raise StoreReadOnlyError(
                f"store '{database}': no lock file can be made beside it ({error.strerror}); make the folder writable"
            ) from error
        fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def holds(self) -> bool:
        """The operating system sees to it."""
        return True

    def release(self) -> None:
        """Let go. Safe to call twice."""
        self._path.unlink(missing_ok=True)
        self._file.close()


def lives(database: Path, token: str | None) -> bool:
    """True while the process that made this claim holds it; what a dead process left is removed."""
    if token is None:
        return False
    path = _lock_path(database, token)
    try:
        with path.open("r+") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink(missing_ok=True)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


def _lock_path(database: Path, token: str) -> Path:
    return database.with_name(f"{database.name}-owner-{token}")
