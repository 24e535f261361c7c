"""TOML files as pydantic models; errors name the file, the line and the key."""

import re
import tomllib
from collections import Counter
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from bench.config.validation import problems
from bench.recording_set.errors import RecordingSetError

MOST_BYTES = 2**20
LONGEST_LINE = 2**14  # characters
MOST_PARTS = 64  # of a key, with a point between them: tomllib's time and memory grow with their square
_BETWEEN_KEYS = re.compile(r"[=,#{}\[\]:;()]")  # in no key without quotation marks; numbers stand between them, too
Model = TypeVar("Model", bound=BaseModel)


def read_model(path: Path, model: type[Model]) -> Model:
    """The content of a TOML file on the disk.

    Raises:
        RecordingSetError: not there, or as `parse_toml`; names file, line and key.
    """
    try:
        return parse_toml(path.read_bytes(), model, path.name)
    except OSError as error:
        kind = model.__name__.lower()
        raise RecordingSetError(str(path), f"cannot be read: {error.strerror}; name a {kind} file") from error


def parse_toml(data: bytes, model: type[Model], file: str) -> Model:
    """The content of a TOML file.

    Raises:
        RecordingSetError: no TOML, an unknown key, a value of the wrong type or out of range.
    """
    if len(data) > MOST_BYTES:
        raise RecordingSetError(file, f"is larger than {MOST_BYTES} bytes; that is no {model.__name__.lower()} file")
    try:
        text = data.decode("utf-8-sig")
        _check_lines(text, file)
        return model.model_validate(tomllib.loads(text))
    except UnicodeDecodeError as error:
        message = f"found byte 0x{data[error.start]:02X}, which is not UTF-8; save the file as UTF-8"
        raise RecordingSetError(file, message, data.count(b"\n", 0, error.start) + 1) from error
    except ValidationError as error:
        lines = [line_of(text, detail["loc"]) for detail in error.errors(include_url=False)]
        first, *others = problems(error, model=model)
        more = "".join(f"\n{file}, line {line}: {problem}" for line, problem in zip(lines[1:], others, strict=True))
        raise RecordingSetError(file, first + more, lines[0]) from error
    except RecordingSetError:
        raise
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a plain ValueError
        raise RecordingSetError(file, f"is no TOML: {error}") from error


def _check_lines(text: str, file: str) -> None:
    for number, line in enumerate(text.splitlines(), start=1):
        if len(line) > LONGEST_LINE:
            message = f"has {len(line)} characters in this line; allowed are {LONGEST_LINE}. Write it in several lines"
            raise RecordingSetError(file, message, number)
        if (parts := max(piece.count(".") for piece in _BETWEEN_KEYS.split(line)) + 1) > MOST_PARTS:
            message = f"has {parts} words with points between them in this line; allowed are {MOST_PARTS}"
            raise RecordingSetError(file, message, number)


def line_of(text: str, location: tuple[int | str, ...]) -> int:
    """The line of a key, from 1; where the key is missing the line of what holds it."""
    table: tuple[int | str, ...] = ()
    counts: Counter[str] = Counter()
    best, depth = 1, 0
    for number, line in enumerate(text.splitlines(), start=1):
        told, before = line.lstrip(), line.partition("=")[0]
        if told.startswith("["):
            name = told.lstrip("[").partition("]")[0]
            table = _keys(name)
            if told.startswith("[["):
                table += (counts[name],)
                counts[name] += 1
            place = table
        elif before != line and before.strip() and not any(sign in before for sign in "#[]"):
            place = table + _keys(before)
        else:
            continue
        if len(place) > depth and place == location[: len(place)]:
            best, depth = number, len(place)
    return best


def _keys(dotted: str) -> tuple[str, ...]:
    return tuple(part.strip().strip("\"'") for part in dotted.split("."))
