"""A TOML file as a dict, or an error that names the file."""

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
