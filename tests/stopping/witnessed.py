"""`friction-bench` with a witness: `python -m tests.stopping.witnessed WITNESS [--raise-after S] ARGUMENTS...`.

The drive writes into a mapped file what it was last asked and whether it has power. The operating system keeps
that when the process is killed: it is what a device would have seen.
"""

import mmap
import struct
import sys
from pathlib import Path
from typing import Any

from bench import station
from bench.drive_factory import Equipment, make_equipment
from drivers.contract import Command, Mode, Sample

LAYOUT = struct.Struct("=ddq")  # first sample [s], last sample [s], powered


def read(path: Path) -> tuple[float, bool]:
    """How long the drive has been asked for samples [s], and whether it has power."""
    first_s, last_s, powered = LAYOUT.unpack(path.read_bytes())
    return last_s - first_s, bool(powered)


def prepare(path: Path) -> None:
    """A witness that has seen nothing."""
    path.write_bytes(LAYOUT.pack(0.0, 0.0, 0))


class WitnessedDrive:
    """A drive, and what it saw. Everything else is the drive's own."""

    def __init__(self, drive: Any, path: Path, raise_after_s: float) -> None:
        self._drive = drive
        self._raise_after_s = raise_after_s
        self._first_s: float | None = None
        self._last_s = 0.0
        self._powered = 0
        with path.open("r+b") as file:
            self._map = mmap.mmap(file.fileno(), LAYOUT.size)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._drive, name)

    def exchange(self, command: Command) -> Sample:
        if self._first_s is not None and self._last_s - self._first_s > self._raise_after_s:
            raise RuntimeError("the witness has seen enough")
        sample: Sample = self._drive.exchange(command)
        if self._first_s is None:
            self._first_s = sample.time_s
        self._last_s = sample.time_s
        self._write()
        return sample

    def enable(self, mode: Mode) -> None:
        self._powered = 1
        self._write()
        self._drive.enable(mode)

    def disable(self) -> None:
        self._drive.disable()
        self._powered = 0
        self._write()

    def _write(self) -> None:
        LAYOUT.pack_into(self._map, 0, self._first_s or 0.0, self._last_s, self._powered)


def main() -> None:
    """Run a command with every drive witnessed."""
    path, arguments = Path(sys.argv[1]), sys.argv[2:]
    raise_after_s = float("inf")
    if arguments[0] == "--raise-after":
        raise_after_s, arguments = float(arguments[1]), arguments[2:]

    def witnessed(*words: Any) -> Equipment:
        found = make_equipment(*words)
        return Equipment(WitnessedDrive(found.drive, path, raise_after_s), found.technician)  # type: ignore[arg-type]

    station.make_equipment = witnessed
    sys.argv = ["friction-bench", *arguments]
    from bench.cli import main as command

    command()


if __name__ == "__main__":
    main()
