"""`friction-bench` with a drive that raises as soon as a file is there: `python -m tests.stopping.raising FILE`.

An error of no known kind, in the middle of a trial: what a fault of our own software would look like. The words of the
command come as a line of JSON on standard input, when all that takes long to import is there.
"""

import importlib
import json
import sys
from pathlib import Path
from typing import Any

from drivers.contract import Command, Sample

IMPORTED_BEFORE = (
    "bench.cli",
    "bench.cli.operation.serve",
    "bench.cli.operation.run",
    "bench.service.app",
    "bench.service.server",
)


class RaisingDrive:
    """A drive; everything but the raising is its own."""

    def __init__(self, drive: Any, file: Path) -> None:
        self._drive = drive
        self._file = file

    def __getattr__(self, name: str) -> Any:
        return getattr(self._drive, name)

    def exchange(self, command: Command) -> Sample:
        if self._file.exists():
            self._file.unlink()
            raise ZeroDivisionError("a fault of the software")
        found: Sample = self._drive.exchange(command)
        return found


def install(file: Path) -> None:
    """Give every runner of this process such drives."""
    from bench.control import station
    from bench.control.drive_factory import Equipment, make_equipment

    def raising(*words: Any) -> Equipment:
        found = make_equipment(*words)
        return Equipment(RaisingDrive(found.drive, file), found.technician)  # type: ignore[arg-type]

    station.make_equipment = raising


def main() -> None:
    """The command."""
    file = Path(sys.argv[1])
    for name in IMPORTED_BEFORE:
        importlib.import_module(name)
    sys.argv = ["friction-bench", *json.loads(sys.stdin.readline())]
    if "run" in sys.argv:  # the control loop of a service is elsewhere
        install(file)
    from bench.cli import main as command

    command()


if __name__ == "__main__":
    main()
