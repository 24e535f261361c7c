"""Conditions as text: numbers, true and false, and text that stays text.

Text that would be read as something else ("12", "true", "") is written with an apostrophe before it,
as spreadsheets do.
"""

import math
import re

from compensator.lab.recording import Condition

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_FLAGS = {"true": True, "false": False}


def parse(cell: str, decimal: str = ".") -> Condition | None:
    """The condition of a cell; None where it is empty, that is, not known."""
    if cell.startswith("'"):
        bare = cell.lstrip("'")
        return cell if _plain(bare, decimal) == bare else cell[1:]
    return _plain(cell, decimal)


def write(value: Condition | None) -> str:
    """The cell of a condition, from which `parse` makes the same value."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value if parse(value) == value else f"'{value}"
    return repr(float(value))


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
