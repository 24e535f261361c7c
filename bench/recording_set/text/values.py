"""Conditions and events as text: numbers, true and false, and text that stays text.

Text that would be read as something else ("12", "true", "") is written with an apostrophe before it,
as spreadsheets do. So is text that a spreadsheet would run as a formula ("=1+1"), wherever it came from.

Events of a row stand in one cell: "name: detail", several with "; " between them. What cannot be written so (a time
between two rows, a detail with "; " in it) is written as JSON, [[time_s, name, detail], ...]; both forms are read.
"""

import json
import math
import re
from collections.abc import Sequence

from compensator.lab.recordings.recording import Condition, Event

_NUMBER = re.compile(r"[+-]?(\d++(\.\d*+)?|\.\d++)([eE][+-]?\d++)?", re.ASCII)
_FLAGS = {"true": True, "false": False}
_FORMULA_SIGNS = ("=", "+", "-", "@")


def parse(cell: str, decimal: str = ".") -> Condition | None:
    """The condition of a cell; None where it is empty, that is, not known."""
    if cell.startswith("'"):
        bare = cell.lstrip("'")
        return cell if _plain(bare, decimal) == bare and not _is_formula(bare) else cell[1:]
    return _plain(cell, decimal)


def write(value: Condition | None) -> str:
    """The cell of a condition, from which `parse` makes the same value."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return shield(value) if parse(value) == value else f"'{value}"
    return repr(float(value))


def shield(text: str) -> str:
    """The cell of a text that is always text, such as a name: with an apostrophe before what may be a formula."""
    return f"'{text}" if _is_formula(text.lstrip("'")) else text


def unshield(cell: str) -> str:
    """The text that `shield` made the cell from."""
    return cell[1:] if cell.startswith("'") and _is_formula(cell.lstrip("'")) else cell


def _is_formula(text: str) -> bool:
    return text.lstrip().startswith(_FORMULA_SIGNS)


def _plain(cell: str, decimal: str) -> Condition | None:
    text = cell.strip()
    if not text:
        return None
    if text.lower() in _FLAGS:
        return _FLAGS[text.lower()]
    number = text if decimal == "." else text.replace(".", "?").replace(decimal, ".")
    if _NUMBER.fullmatch(number) and math.isfinite(float(number)):
        return float(number)
    return cell


BETWEEN = "; "
BEFORE_DETAIL = ": "


def encode_events(events: Sequence[Event], time_s: float) -> str:
    """The cell for the events of a row at a time [s]; "" for none."""
    cell = shield(BETWEEN.join(event.name + (BEFORE_DETAIL + event.detail if event.detail else "") for event in events))
    if decode_events(cell, time_s) == list(events):
        return cell
    return json.dumps([list(event) for event in events], ensure_ascii=False)


def decode_events(cell: str, time_s: float) -> list[Event]:
    """The events of a cell in a row at a time [s]. Any text is an event's name."""
    if cell.startswith("[["):
        try:
            found = [Event(float(time), str(name), str(detail)) for time, name, detail in json.loads(cell)]
            if all(math.isfinite(event.time_s) for event in found):
                return found
        except (ValueError, TypeError, OverflowError, RecursionError):
            pass  # somebody's own text, which happens to begin so
    if not cell.strip():
        return []
    pairs = (part.partition(BEFORE_DETAIL) for part in unshield(cell).split(BETWEEN))
    return [Event(time_s, name, detail) for name, _, detail in pairs]
