"""Where the files of a recording set are: a folder, a zip, or a single CSV. Nothing is ever unpacked to disk."""

import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import IO, Protocol

from bench.recording_set.errors import RecordingSetError

MOST_FILES = 20_000
MOST_BYTES = 2 * 2**30  # of a zip, unpacked: 18 million rows of 14 channels
MOST_RATIO = 250  # unpacked / packed; tables of numbers reach some 20
RATIO_FROM_BYTES = 64 * 2**20  # smaller ones do no harm


class Container(Protocol):
    """Files by name. Names use "/" and are relative to the set."""

    path: Path

    def files(self) -> list[str]:
        """The files at the top level of the set, sorted."""

    def has(self, file: str) -> bool:
        """Whether the set has this file."""

    def open(self, file: str) -> IO[bytes]:
        """Open a file that the set has."""


class Folder:
    """A recording set in a folder, or of one CSV in it."""

    def __init__(self, path: Path, only: str | None = None) -> None:
        self.path = path if only is None else path / only
        self._folder = path
        self._only = only

    def files(self) -> list[str]:
        """The files at the top level of the set, sorted."""
        if self._only is not None:
            return [self._only]
        return sorted(item.name for item in self._folder.iterdir() if item.is_file())

    def has(self, file: str) -> bool:
        """Whether the set has this file."""
        return (self._only in (None, file)) and (self._folder / file).is_file()

    def open(self, file: str) -> IO[bytes]:
        """Open a file that the set has."""
        return (self._folder / file).open("rb")


class Zip:
    """A recording set in a zip; a single folder that holds everything is looked through."""

    def __init__(self, path: Path, archive: zipfile.ZipFile) -> None:
        self.path = path
        self._archive = archive
        self._members = _members(path.name, archive)

    def files(self) -> list[str]:
        """The files at the top level of the set, sorted."""
        return sorted(file for file in self._members if "/" not in file)

    def has(self, file: str) -> bool:
        """Whether the set has this file."""
        return file in self._members

    def open(self, file: str) -> IO[bytes]:
        """Open a file that the set has."""
        return self._archive.open(self._members[file])


@contextmanager
def open_container(path: Path) -> Iterator[Container]:
    """The files of a recording set.

    Raises:
        RecordingSetError: not there, no permission, no zip, or a zip that is damaged, encrypted, too large or unsafe.
    """
    name = path.name
    try:
        if path.is_dir():
            yield Folder(path)
        elif path.suffix.lower() == ".csv" and path.is_file():
            yield Folder(path.parent, only=path.name)
        elif path.is_file():
            with zipfile.ZipFile(path) as archive:
                yield Zip(path, archive)
        else:
            raise RecordingSetError(str(path), "there is no such folder or file; name a folder, a zip or a CSV")
    except (zipfile.BadZipFile, zlib.error, EOFError) as error:
        raise RecordingSetError(
            name, f"is no zip, or a damaged one ({error}); make it again, or name a folder"
        ) from error
    except (NotImplementedError, RuntimeError) as error:  # zipfile's words for compression and encryption
        raise RecordingSetError(name, f"cannot be unpacked ({error}); zip it again without a password") from error
    except OSError as error:
        file = Path(error.filename).name if error.filename else name
        raise RecordingSetError(file, f"cannot be read: {error.strerror or error}") from error


def check_name(file: str, place: str, line: int | None = None, column: str | None = None) -> None:
    """Refuse a file name that leads out of the set.

    Raises:
        RecordingSetError: absolute, with "..", or not of the kind that every system can have.
    """
    parts = PurePosixPath(file).parts
    if not parts or parts[0] == "/" or ".." in parts or any(sign in file for sign in "\\:\0"):
        message = f"the file name '{file}' leads out of the set; wanted a name relative to it, with '/' alone"
        raise RecordingSetError(place, message, line, column)


def _members(name: str, archive: zipfile.ZipFile) -> dict[str, zipfile.ZipInfo]:
    infos = [info for info in archive.infolist() if not info.is_dir() and not info.filename.startswith("__MACOSX/")]
    _check_size(name, infos)
    found: dict[str, zipfile.ZipInfo] = {}
    for info in infos:
        check_name(info.filename, name)
        if info.filename in found:
            raise RecordingSetError(name, f"holds '{info.filename}' twice; make the zip again")
        found[info.filename] = info
    tops = {file.partition("/")[0] for file in found}
    if len(tops) == 1 and all("/" in file for file in found):
        return {file.partition("/")[2]: info for file, info in found.items()}
    return found


def _check_size(name: str, infos: list[zipfile.ZipInfo]) -> None:
    if len(infos) > MOST_FILES:
        raise RecordingSetError(name, f"holds {len(infos)} files; at most {MOST_FILES} are read. Split the set")
    total = sum(info.file_size for info in infos)
    if total > MOST_BYTES:
        raise RecordingSetError(name, f"unpacks to {total} bytes; at most {MOST_BYTES} are read. Split the set")
    packed = sum(info.compress_size for info in infos)
    if total > RATIO_FROM_BYTES and total > MOST_RATIO * packed:
        message = f"unpacks to {total / max(packed, 1):.0f} times its size; at most {MOST_RATIO} is read. Name a folder"
        raise RecordingSetError(name, message)
