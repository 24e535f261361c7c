"""TOML files as pydantic models; errors name the file, the line and the key."""

import re
import tomllib
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from bench.recording_set.errors import RecordingSetError
from bench.validation import problems

MOST_BYTES = 2**20
Model = TypeVar("Model", bound=BaseModel)
_TABLE = re.compile(r"\s*\[+\s*([^\[\]]+?)\s*\]+")


def parse_toml(data: bytes, model: type[Model], file: str) -> Model:
    """The content of a TOML file.

    Args:
        data: the file.
        model: what it holds.
        file: its name, for errors.

    Raises:
        RecordingSetError: no TOML, an unknown key, a value of the wrong type or out of range.
    """
    if len(data) > MOST_BYTES:
        raise RecordingSetError(file, f"is larger than {MOST_BYTES} bytes; that is no {model.__name__.lower()} file")
    try:
        text = data.decode("utf-8-sig")
        return model.model_validate(tomllib.loads(text))
    except UnicodeDecodeError as error:
        message = f"found byte 0x{data[error.start]:02X}, which is not UTF-8; save the file as UTF-8"
        raise RecordingSetError(file, message, data.count(b"\n", 0, error.start) + 1) from error
    except tomllib.TOMLDecodeError as error:
        raise RecordingSetError(file, f"is no TOML: {error}") from error
    except ValidationError as error:
        lines = [line_of(text, detail["loc"]) for detail in error.errors(include_url=False)]
        first, *others = problems(error)
        more = "".join(f"\n{file}, line {line}: {problem}" for line, problem in zip(lines[1:], others, strict=True))
        raise RecordingSetError(file, first + more, lines[0]) from error


def line_of(text: str, location: tuple[int | str, ...]) -> int:
    """The line of a key, from 1; of its table where the key is missing, and 1 where that is missing too."""
    *tables, key = [str(part) for part in location if isinstance(part, str)] or [""]
    wanted, present, best = ".".join(tables), "", 1
    for number, line in enumerate(text.splitlines(), start=1):
        if header := _TABLE.fullmatch(line.partition("#")[0].rstrip()):
            present = header[1].replace('"', "").replace(" ", "")
            if present in (wanted, ".".join([*tables, key])):
                best = number
        elif present == wanted and re.match(rf'\s*"?{re.escape(key)}"?\s*=', line):
            return number
    return best
