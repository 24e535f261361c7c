"""JSON: one object a line, a list of objects, or one object of lists."""

import json
import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.column_table import ColumnTable, check_unpacked, table_of
from bench.recording_set.text.encoding import UTF_8, encoding_of

JsonObject = Mapping[str, Any]
GROWS = 16  # times: a number of two characters is an object of 28 bytes, and stands in a list


def read(place: str, data: bytes) -> ColumnTable:
    """The columns of a JSON file; objects within objects are names with points.

    Raises:
        RecordingSetError: no JSON, or no columns of numbers.
    """
    check_unpacked(place, GROWS * len(data))
    text = data.decode(encoding_of(data[:4096]) or UTF_8, errors="replace")
    rows = _rows(place, text)
    if isinstance(rows, dict):
        return table_of(place, {name: _array(values) for name, values in _flat(rows) if isinstance(values, list)})
    flat = [dict(_flat(row)) for row in rows if isinstance(row, dict)]
    names = dict.fromkeys(name for row in flat for name in row)
    return table_of(place, {name: _array([row.get(name) for row in flat]) for name in names})


def _rows(place: str, text: str) -> list[Any] | JsonObject:
    try:
        whole = json.loads(text)
    except (ValueError, RecursionError):  # a number of thousands of digits is a plain ValueError
        whole = None
    if isinstance(whole, dict | list):
        return whole
    rows = []
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        try:
            rows.append(json.loads(line))
        except (ValueError, RecursionError) as error:
            message = f"is no JSON ({error}); wanted one object a line, such as a number under each name"
            raise RecordingSetError(place, message, number) from error
    return rows


def _flat(row: JsonObject, prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in row.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        elif isinstance(value, list) and prefix + name and len(value) <= 1:
            yield f"{prefix}{name}", value[0] if value else None
        else:
            yield f"{prefix}{name}", value


def _float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:  # an integer beyond all of them
        return math.inf if value > 0 else -math.inf


def _array(values: list[Any]) -> Any:
    """Numbers where there are any and nothing else; else text."""
    if any(isinstance(value, list | dict) for value in values):
        lengths = {len(value) for value in values if isinstance(value, list)}
        if len(lengths) == 1 and all(isinstance(value, list) for value in values):
            try:
                return np.array(values, dtype=float)
            except (TypeError, ValueError, OverflowError):
                return [str(value) for value in values]
        return [str(value) for value in values]
    if all(value is None or isinstance(value, int | float) for value in values):
        return np.array([np.nan if value is None else _float(value) for value in values])
    return ["" if value is None else str(value) for value in values]
