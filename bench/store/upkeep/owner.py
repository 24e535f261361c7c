"""Who runs an experiment, whether that process still lives, and its last words.

A process that runs experiments keeps a small file beside the database locked. The operating system
lets go of the lock when the process ends, however it ends, and a process id that was given away
again cannot be mistaken for it. The file is made and removed inside a transaction that writes, so
two processes never do so at once.

The file has its full size from the start: what is noted in it later needs no room on the disk.
"""

import errno
import fcntl
import json
import os
import uuid
from collections.abc import Mapping
from pathlib import Path

from bench.store.errors import StoreFullError, StoreReadOnlyError

NOTE_BYTES = 8192
LONGEST_REASON = 1000  # characters


class Owner:
    """A claim: held until `release`, or until the process is gone.

    Raises:
        StoreFullError, StoreReadOnlyError: no file can be made beside the database.
    """

    def __init__(self, database: Path) -> None:
        self.token = f"{os.getpid()}-{uuid.uuid4().hex[:12]}"
        self._path = _lock_path(database, self.token)
        try:
            self._file = self._path.open("w+b", buffering=0)
            self._file.write(b" " * NOTE_BYTES)
            os.fsync(self._file.fileno())
        except OSError as error:
            self._path.unlink(missing_ok=True)
            if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
                raise StoreFullError(f"store '{database}': the disk is full; free some space, then go on") from error
            raise StoreReadOnlyError(
                f"store '{database}': no lock file can be made beside it ({error.strerror}); make the folder writable"
            ) from error
        fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def holds(self) -> bool:
        """The operating system sees to it."""
        return True

    def note(self, ends: Mapping[int, tuple[str, str]]) -> None:
        """Keep how experiments ended, in place of what was noted before."""
        short = [(number, outcome, reason[:LONGEST_REASON]) for number, (outcome, reason) in ends.items()]
        while len(text := json.dumps({number: end for number, *end in short})) > NOTE_BYTES:
            short.pop(0)  # the newest matter most
        os.pwrite(self._file.fileno(), text.encode().ljust(NOTE_BYTES), 0)
        os.fsync(self._file.fileno())

    def release(self, keep_note: bool = False) -> None:
        """Let go. Safe to call twice."""
        if not keep_note:
            self._path.unlink(missing_ok=True)
        self._file.close()


def lives(database: Path, token: str | None) -> bool:
    """True while the process that made this claim holds it."""
    if token is None:
        return False
    try:
        with _lock_path(database, token).open("r+") as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


def last_words(database: Path, token: str | None) -> dict[int, tuple[str, str]]:
    """How experiments ended whose end the database did not take, as a process noted before it was gone."""
    try:
        text = _lock_path(database, token or "").read_text(encoding="utf-8").strip()
        found = json.loads(text or "{}")
        return {int(number): (str(outcome), str(reason)) for number, (outcome, reason) in found.items()}
    except (OSError, ValueError, TypeError, AttributeError):
        return {}  # nothing noted, or a note that was cut off


def forget(database: Path, token: str | None) -> None:
    """Remove what a dead process left."""
    if token is not None:
        _lock_path(database, token).unlink(missing_ok=True)


def _lock_path(database: Path, token: str) -> Path:
    return database.with_name(f"{database.name}-owner-{token}")
