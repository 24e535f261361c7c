"""A TOML file as a dict, or an error that names the file."""

import re
import tomllib
from pathlib import Path
from typing import Any

from bench.errors import ConfigurationError


def read_toml(path: Path) -> dict[str, Any]:
    """What a file of the bench's own holds.

    Raises:
        ConfigurationError: names the file: it cannot be read, is no TOML, or nests or counts beyond any use.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read: {error.strerror}") from error
    except (ValueError, RecursionError) as error:  # a number of thousands of digits is a plain ValueError
        raise ConfigurationError(f"{path}: is no TOML: {error}") from error


def set_number(path: Path, table: str, key: str, value: float) -> None:
    """Change one number of a file, and nothing else in it: comments and order stay. All of it is written, or nothing.

    Args:
        path: of the file.
        table: "drive" for a key below `[drive]`, which has to be there.
        key: is added below the heading of the table where it is not there.
        value: the number.

    Raises:
        ConfigurationError: the file has no such table, writes it in another way, or cannot be written.
    """
    text = _read_text(path)
    heading = re.search(rf"^[ \t]*\[[ \t]*{re.escape(table)}[ \t]*\][^\n]*$", text, re.MULTILINE)
    if heading is None:
        raise ConfigurationError(f"{path}: has no line [{table}]; write {key} = {value!r} into it by hand")
    begin = heading.end()
    following = re.search(r"^[ \t]*\[", text[begin:], re.MULTILINE)
    end = begin + following.start() if following else len(text)
    body, count = re.subn(
        rf"^([ \t]*{re.escape(key)}[ \t]*=[ \t]*)[^\s#]+",
        rf"\g<1>{value!r}",
        text[begin:end],
        count=1,
        flags=re.MULTILINE,
    )
    if not count:
        body = f"\n{key} = {value!r}{body or chr(10)}"
    changed = text[:begin] + body + text[end:]
    if tomllib.loads(changed)[table][key] != value:
        raise ConfigurationError(f"{path}: {key} of [{table}] could not be changed; write {key} = {value!r} by hand")
    unfinished = path.with_name(f".{path.name}.part")
    try:
        unfinished.write_text(changed, encoding="utf-8")
        unfinished.replace(path)
    except OSError as error:
        unfinished.unlink(missing_ok=True)
        raise ConfigurationError(f"{path}: cannot be written: {error.strerror}") from error


def _read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read: {error.strerror}") from error
