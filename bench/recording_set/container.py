"""Where the files of a recording set are: a folder, a zip, or files of their own. Nothing is ever unpacked to disk."""

import zipfile
import zlib
from collections.abc import Iterator, Sequence
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
    """A recording set in a folder."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def files(self) -> list[str]:
        """The files at the top level of the set, sorted."""
        return sorted(item.name for item in self.path.iterdir() if item.is_file())

    def has(self, file: str) -> bool:
        """Whether the set has this file."""
        return (self.path / file).is_file()

    def open(self, file: str) -> IO[bytes]:
        """Open a file that the set has."""
        return (self.path / file).open("rb")


class Files:
    """A recording set of single files, each a trial, in the order given."""

    def __init__(self, paths: Sequence[Path]) -> None:
        self.path = paths[0] if len(paths) == 1 else paths[0].parent
        self._paths: dict[str, Path] = {}
        for path in paths:
            name = path.name if path.name not in self._paths else f"{path.parent.name}/{path.name}"
            if name in self._paths:
                raise RecordingSetError(str(path), "is named twice; name each file once")
            self._paths[name] = path

    def files(self) -> list[str]:
        """Their names; where two are called the same, with the folder before it."""
        return list(self._paths)

    def has(self, file: str) -> bool:
        """Whether it is one of them."""
        return file in self._paths

    def open(self, file: str) -> IO[bytes]:
        """Open one of them."""
        return self._paths[file].open("rb")


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
        with _names_decoded():
            return self._archive.open(self._members[file])


@contextmanager
def _names_decoded() -> Iterator[None]:
    """A name that is no text damages a zip, as other bytes do; zipfile has no word for it."""
    try:
        yield
    except UnicodeDecodeError as error:
        raise zipfile.BadZipFile(f"the name of a file is no UTF-8: {error.reason}") from error


@contextmanager
def open_container(*paths: Path) -> Iterator[Container]:
    """The files of a recording set: a folder, a zip, or one file or more, each a trial.

    Raises:
        RecordingSetError: not there, no permission, no zip, or a zip that is damaged, encrypted, too large or unsafe.
    """
    path = paths[0]
    name = path.name
    try:
        for one in paths:
            if not one.exists():
                raise RecordingSetError(str(one), "there is no such folder or file; name a folder, a zip or files")
        if len(paths) > 1 and (wrong := [one for one in paths if one.is_dir()]):
            raise RecordingSetError(str(wrong[0]), "is a folder among files; name one folder, or files")
        if path.is_dir():
            yield Folder(path)
        elif path.suffix.lower() == ".zip" and len(paths) == 1:
            with _names_decoded():
                archive = zipfile.ZipFile(path)
            with archive:
                yield Zip(path, archive)
        else:
            yield Files(paths)
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
