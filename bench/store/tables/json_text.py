"""JSON as the store writes and reads it: what is not a number is null, numpy's scalars and arrays are plain numbers."""

import json
import math
from collections.abc import Mapping, Sequence
from datetime import date
from enum import Enum
from typing import Any

import numpy as np

from bench.store.schema import UnreadableError


class NoJsonError(TypeError):
    """Raised for something that JSON has no form for."""


def plain(value: Any) -> Any:
    """The value from dicts, lists, text, numbers, bools and None alone; NaN and infinity become None.

    Raises:
        NoJsonError: something that JSON has no form for.
    """
    match value:
        case None | bool() | int() | str():
            return value.value if isinstance(value, Enum) else value
        case float():
            return float(value) if math.isfinite(value) else None
        case np.generic() | np.ndarray():
            return plain(value.tolist())
        case Enum():
            return plain(value.value)
        case date():
            return value.isoformat()
        case Mapping():
            return {str(key): plain(item) for key, item in value.items()}
        case Sequence() | set() | frozenset():
            return [plain(item) for item in value]
    raise NoJsonError(f"a {type(value).__name__} cannot be kept as JSON: {value!r}")


def to_json(value: Any) -> str:
    """Compact JSON text."""
    return json.dumps(plain(value), allow_nan=False, ensure_ascii=False, separators=(",", ":"))


def from_json(text: str | bytes) -> Any:
    """What a column of JSON holds.

    Raises:
        UnreadableError: it is no JSON.
    """
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise UnreadableError(f"no JSON: {error}") from error
