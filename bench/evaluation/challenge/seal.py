"""Seals an answer, so that nobody reads it by accident, and a change of it or of the recordings is noticed.

This is no encryption: whoever wants to read the answer can.
"""

import base64
import hashlib
import json
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import TypedDict

from bench.errors import BenchError
from bench.evaluation.challenge.answer import Answer

WHAT = "sealed answer of a friction-bench challenge; open it with: friction-bench reveal"
_KEYS = ("what", "recordings_sha256", "sealed", "sha256")
_LINE = 76


class _Sealed(TypedDict):
    """The file."""

    what: str
    recordings_sha256: str
    sealed: list[str]
    sha256: str


class SealError(BenchError, ValueError):
    """Raised when an answer file cannot be opened.

    - it is missing or is no sealed answer
    - it was changed after it was sealed
    - the recordings beside it are not those that it was sealed with
    """


def answer_path(output: Path) -> Path:
    """Where the answer to a recording set is written."""
    return output.with_name(output.name.removesuffix(".zip") + ".answer")


def check_free(output: Path) -> None:
    """Refuse places that are taken, before anything is computed.

    Raises:
        SealError: the recordings or their answer are there already.
    """
    for taken in (answer_path(output), output):
        if taken.exists():
            raise SealError(f"{taken}: is there already; name another place with --output, or remove it")


def write_sealed(answer: Answer, recordings: Path, path: Path) -> None:
    """Write an answer file that belongs to a recording set.

    Raises:
        SealError: it cannot be written.
    """
    coded = sealed(answer)
    lines = [coded[start : start + _LINE] for start in range(0, len(coded), _LINE)]
    digest = digest_of(recordings)
    values = _Sealed(what=WHAT, recordings_sha256=digest, sealed=lines, sha256=_digest(digest, lines))
    try:
        path.write_text(json.dumps(values, indent=1) + "\n", encoding="utf-8")
    except OSError as error:
        raise SealError(f"{path}: cannot be written: {error.strerror}") from error


def sealed(answer: Answer) -> str:
    """An answer as one line of text that a glance does not read."""
    text = json.dumps(answer.to_json(), sort_keys=True)
    return base64.b85encode(zlib.compress(text.encode(), 9)).decode()


def unsealed(text: str, where: str) -> Answer:
    """The answer in a line of text.

    Args:
        text: as `sealed` made it.
        where: it stands, for the message.

    Raises:
        SealError: it is no such line.
    """
    try:
        return Answer.from_json(json.loads(zlib.decompress(base64.b85decode(text))))
    except (ValueError, zlib.error, KeyError, TypeError) as error:
        raise SealError(f"{where}: the sealed answer cannot be opened: {error}") from error


def read_sealed(path: Path, recordings: Path | None = None) -> Answer:
    """Open an answer file.

    Args:
        path: of the file.
        recordings: the set that it should belong to; None: not compared.

    Raises:
        SealError: it is no answer file, or it or the recordings were changed.
    """
    values = _read(path)
    if values["sha256"] != _digest(values["recordings_sha256"], values["sealed"]):
        raise SealError(f"{path}: was changed after it was sealed; take the file as the challenge wrote it")
    if recordings is not None and digest_of(recordings) != values["recordings_sha256"]:
        raise SealError(f"{recordings}: are not the recordings that {path} was sealed with, or were changed since")
    return unsealed("".join(values["sealed"]), str(path))


def digest_of(recordings: Path) -> str:
    """SHA-256 over names and contents of a recording set: a folder or a zip.

    Raises:
        SealError: it cannot be read.
    """
    found = hashlib.sha256()
    try:
        for name, content in _files(recordings):
            found.update(f"{name}\n{len(content)}\n".encode() + content)
    except (OSError, zipfile.BadZipFile) as error:
        raise SealError(f"{recordings}: cannot be read: {error}") from error
    return found.hexdigest()


def _files(recordings: Path) -> list[tuple[str, bytes]]:
    if recordings.is_dir():
        return [(path.name, path.read_bytes()) for path in sorted(recordings.iterdir())]
    with zipfile.ZipFile(recordings) as archive:
        return [(name, archive.read(name)) for name in sorted(archive.namelist())]


def _read(path: Path) -> _Sealed:
    try:
        values = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SealError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError:
        values = None
    if not isinstance(values, dict) or set(values) != set(_KEYS) or values["what"] != WHAT:
        raise SealError(f"{path}: is no sealed answer; wanted the file that 'friction-bench challenge' wrote")
    return _Sealed(
        what=WHAT,
        recordings_sha256=str(values["recordings_sha256"]),
        sealed=list(map(str, values["sealed"])),
        sha256=str(values["sha256"]),
    )


def _digest(recordings_sha256: str, sealed: Sequence[str]) -> str:
    parts = [WHAT, str(recordings_sha256), *map(str, sealed)]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()
