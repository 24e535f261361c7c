"""A campaign from a TOML file."""

import tomllib
from pathlib import Path

from pydantic import ValidationError

from bench.config.validation import problems
from bench.errors import ConfigurationError
from bench.runs.queue.campaign import Campaign


def read_campaign(path: Path) -> Campaign:
    """Read a campaign; without a name it has that of its file.

    Raises:
        ConfigurationError: naming the file, each key, what was found and what is wanted.
    """
    try:
        values = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(f"{path}: cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path}: is no TOML: {error}") from error
    try:
        return Campaign.model_validate({"name": path.stem} | values)
    except ValidationError as error:
        raise ConfigurationError(
            "\n".join(f"{path}: {problem}" for problem in problems(error, model=Campaign))
        ) from error
