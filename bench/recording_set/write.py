"""Write a recording set: what is written reads back as the same numbers, bit for bit."""

import io
import re
import tempfile
import zipfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import IO

import numpy as np
import tomli_w

from bench.recording_set import events as event_cells
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.read import RIG_FILE
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.table import quoted
from bench.recording_set.trials_csv import TRIALS_FILE, TrialEntry, write_trials_csv
from bench.rig import Rig
from compensator.lab.channels import EVENT_COLUMN
from compensator.lab.recording import Event, FloatArray, Recording

CHUNK_ROWS = 8192
LONGEST_NAME = 100
_FOREVER = (1980, 1, 1, 0, 0, 0)  # the same set makes the same zip
OpenFile = Callable[[str], AbstractContextManager[IO[str]]]


def write_recording_set(recording_set: RecordingSet, path: Path) -> None:
    """Write a folder, or a zip where the name ends in .zip. All of it appears, or nothing.

    Raises:
        RecordingSetError: the place is taken or cannot be written, or a condition's name cannot be a column.
    """
    write_recordings(recording_set.rig, recording_set.recordings, path)


def write_recordings(rig: Rig, recordings: Iterable[Recording], path: Path) -> None:
    """As `write_recording_set`, one recording in memory at a time."""
    path = Path(path).absolute()
    if path.is_file() or (path.is_dir() and any(path.iterdir())):
        raise RecordingSetError(str(path), "is there already; name another place, or remove it")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{path.name[:LONGEST_NAME]}-", dir=path.parent) as folder:
            unfinished = Path(folder) / "set"
            _write(rig, recordings, unfinished, zipped=path.suffix.lower() == ".zip")
            if path.is_dir():
                path.rmdir()
            unfinished.rename(path)
    except OSError as error:
        raise RecordingSetError(str(path), f"cannot be written: {error.strerror or error}") from error


def _write(rig: Rig, recordings: Iterable[Recording], path: Path, *, zipped: bool) -> None:
    with _zip(path) if zipped else _folder(path) as open_file:
        with open_file(RIG_FILE) as file:
            file.write(tomli_w.dumps(_known(rig)))
        entries: list[TrialEntry] = []
        taken = {RIG_FILE, TRIALS_FILE}
        for recording in recordings:
            name = _file_name(recording.name, taken)
            with open_file(name) as file:
                file.writelines(csv_chunks(recording))
            entries.append(TrialEntry(name, recording.name, recording.kind, recording.conditions, len(recording)))
        with open_file(TRIALS_FILE) as file:
            write_trials_csv(file, entries)


@contextmanager
def _folder(path: Path) -> Iterator[OpenFile]:
    path.mkdir()
    yield lambda name: (path / name).open("w", encoding="utf-8", newline="")


@contextmanager
def _zip(path: Path) -> Iterator[OpenFile]:
    with zipfile.ZipFile(path, "w") as archive:

        @contextmanager
        def open_file(name: str) -> Iterator[IO[str]]:
            info = zipfile.ZipInfo(name, _FOREVER)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = 0o644 << 16
            with (
                archive.open(info, "w", force_zip64=True) as binary,
                io.TextIOWrapper(binary, encoding="utf-8", newline="") as file,
            ):
                yield file

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


def csv_chunks(recording: Recording) -> Iterator[str]:
    """The CSV of a recording, in pieces of `CHUNK_ROWS` lines: the text of one piece is in memory at a time."""
    names = list(recording.channels)
    time_s = recording.channels["time_s"]
    cells = _event_cells(recording.events, time_s)
    yield ",".join([*names, EVENT_COLUMN] if cells else names) + "\n"
    for start in range(0, len(recording), CHUNK_ROWS):
        rows = slice(start, start + CHUNK_ROWS)
        columns = [_texts(recording.channels[name][rows]) for name in names]
        if cells:
            columns.append([quoted(cells.get(row, "")) for row in range(*rows.indices(len(recording)))])
        yield "".join(f"{line}\n" for line in map(",".join, zip(*columns, strict=True)))


def _texts(values: FloatArray) -> list[str]:
    """The shortest text of each number that reads back as the same number; nothing for NaN."""
    texts = list(map(repr, values.tolist()))
    for row in np.flatnonzero(np.isnan(values)):
        texts[row] = ""
    return texts


def _event_cells(events: Iterable[Event], time_s: FloatArray) -> dict[int, str]:
    """Row -> cell. An event stands in the first row that is not before it, or in the last row."""
    of_row: dict[int, list[Event]] = {}
    for event in events:
        row = min(int(np.searchsorted(time_s, event.time_s)), len(time_s) - 1)
        of_row.setdefault(row, []).append(event)
    return {row: event_cells.encode(found, float(time_s[row])) for row, found in of_row.items()}
