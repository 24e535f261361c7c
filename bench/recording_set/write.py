"""Write a recording set: what is written reads back as the same numbers, bit for bit."""

import re
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import IO

import tomli_w

from bench.config.rig import Rig
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.read import RIG_FILE
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.stream import RecordingStream, stream_of
from bench.recording_set.text.csv_text import csv_chunks
from bench.recording_set.trials_csv import TRIALS_FILE, TrialEntry, trials_csv_lines

LONGEST_NAME = 100
_FOREVER = (1980, 1, 1, 0, 0, 0)  # the same set makes the same zip
OpenFile = Callable[[str], AbstractContextManager[IO[bytes]]]


def write_recording_set(recording_set: RecordingSet, path: Path) -> None:
    """Write a folder, or a zip where the name ends in .zip. All of it appears, or nothing.

    Raises:
        RecordingSetError: the place is taken or cannot be written, or a condition's name cannot be a column.
    """
    write_streams(recording_set.rig, map(stream_of, recording_set.recordings), path)


def write_streams(rig: Rig, streams: Iterable[RecordingStream], path: Path) -> None:
    """As `write_recording_set`, one piece of one recording in memory at a time."""
    path = Path(path).absolute()
    if path.is_file() or (path.is_dir() and any(path.iterdir())):
        raise RecordingSetError(str(path), "is there already; name another place, or remove it")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{path.name[:LONGEST_NAME]}-", dir=path.parent) as folder:
            unfinished = Path(folder) / "set"
            _write(rig, streams, unfinished, zipped=path.suffix.lower() == ".zip")
            if path.is_dir():
                path.rmdir()
            unfinished.rename(path)
    except OSError as error:
        raise RecordingSetError(str(path), f"cannot be written: {error.strerror or error}") from error


def _write(rig: Rig, streams: Iterable[RecordingStream], path: Path, *, zipped: bool) -> None:
    with _zip(path) if zipped else _folder(path) as open_file:
        with open_file(RIG_FILE) as file:
            file.write(tomli_w.dumps(_known(rig)).encode())
        entries: list[TrialEntry] = []
        taken = {RIG_FILE, TRIALS_FILE}
        for stream in streams:
            name = _file_name(stream.name, taken)
            with open_file(name) as file:
                file.writelines(csv_chunks(stream))
            entries.append(TrialEntry(name, stream.name, stream.kind, dict(stream.conditions), stream.rows))
        with open_file(TRIALS_FILE) as file:
            file.writelines(line.encode() for line in trials_csv_lines(entries))


@contextmanager
def _folder(path: Path) -> Iterator[OpenFile]:
    path.mkdir()
    yield lambda name: (path / name).open("wb")


@contextmanager
def _zip(path: Path) -> Iterator[OpenFile]:
    with zipfile.ZipFile(path, "w") as archive:

        def open_file(name: str) -> IO[bytes]:
            info = zipfile.ZipInfo(name, _FOREVER)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = 0o644 << 16
            return archive.open(info, "w", force_zip64=True)

        yield open_file


def _known(rig: Rig) -> dict[str, object]:
    values = rig.model_dump(mode="json", exclude_none=True)
    return {key: value for key, value in values.items() if value != {}}


def _file_name(name: str, taken: set[str]) -> str:
    """A file name that every system can have, and that no other file of the set has."""
    safe = re.sub(r"[^A-Za-z0-9._=+-]", "_", name).lstrip(".-")[:LONGEST_NAME] or "trial"
    file, count = f"{safe}.csv", 1
    while file.lower() in taken:
        count += 1
        file = f"{safe}_{count}.csv"
    taken.add(file.lower())
    return file
