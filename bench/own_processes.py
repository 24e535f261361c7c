"""The processes of this user on this machine that can move a joint: services, and commands that run experiments.

Each leaves a file in the user's own folder while it lives, and keeps it locked. The operating system lets go of the
lock when the process ends, however it ends, so that a process id that was given away again cannot be mistaken for it.
`friction-bench stop` finds them there.
"""

import fcntl
import json
import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path

from bench.own_service import own_folder

STOP_SUFFIX, MOVES_SUFFIX = ".stop", ".moves"  # files of a command: its stop line; there while an experiment runs
_BOOT = Path("/proc/sys/kernel/random/boot_id")


@dataclass(frozen=True, slots=True)
class OwnProcess:
    """What a process tells of itself.

    Attributes:
        what: the command, "friction-bench run steps".
        process_id: as the process itself sees it.
        url: of a service, as this machine reaches it; "" for a command.
        token: for that service, of this user.
        certificate: of that service, in PEM; "" where it speaks plain HTTP.
        machine: where it runs, since it was started; a home folder may be shared.
    """

    what: str
    bench: str
    process_id: int
    url: str = ""
    token: str = ""
    certificate: str = ""
    machine: str = ""

    @property
    def title(self) -> str:
        """As a message names it."""
        name = self.url or self.what
        return f"{name} (bench '{self.bench}', process {self.process_id})"


def new_file() -> Path | None:
    """A path for the file of this process, which does not exist; its folder does. None where there can be none."""
    folder = own_folder()
    if folder is None:
        return None
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return None
    return folder / f"process-{os.getpid()}-{uuid.uuid4().hex[:12]}.json"


@contextmanager
def announced(path: Path, told: OwnProcess) -> Iterator[None]:
    """While it lasts the process is found; the file is complete and locked before it has its name.

    Raises:
        OSError: the file cannot be written.
    """
    draft = path.with_suffix(".new")
    # O_EXCL: never follow a link that somebody else has put there
    with os.fdopen(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            json.dump(asdict(told) | {"machine": _machine()}, file)
            file.flush()
            draft.rename(path)
            yield
        finally:
            for one in (draft, path):
                one.unlink(missing_ok=True)


def own_processes() -> list[tuple[Path, OwnProcess]]:
    """Those that live, with their files. What killed ones have left is removed."""
    folder, found = own_folder(), []
    for path in sorted(folder.glob("process-*.json")) if folder is not None else ():
        with suppress(OSError, ValueError, TypeError):  # it has just ended
            told = OwnProcess(**json.loads(path.read_text(encoding="utf-8")))
            if told.machine != _machine() or path.stat().st_uid != os.geteuid():
                continue
            if lives(path):
                found.append((path, told))
            else:
                for one in (path.with_suffix(STOP_SUFFIX), path.with_suffix(MOVES_SUFFIX), path):
                    one.unlink(missing_ok=True)
    return found


def lives(path: Path) -> bool:
    """Whether the process of a file is there."""
    try:
        with path.open(encoding="utf-8") as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except FileNotFoundError:
        return False
    except BlockingIOError:
        return True
    return False


def _machine() -> str:
    """Name of the machine, and which start of it."""
    try:
        return f"{os.uname().nodename} {_BOOT.read_text(encoding='ascii').strip()}"
    except OSError:
        return os.uname().nodename
