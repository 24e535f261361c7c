"""Cells to numbers: float64 exactly, an empty cell is NaN."""

import io
from collections.abc import Sequence

import numpy as np

from bench.recording_set.text.dialect import BLANKS
from bench.recording_set.text.stamps import BadCell
from compensator.lab.recordings.recording import FloatArray

NOTHING = ("", "na", "n/a", "#n/a", "null", "none", "-", "--", "---")  # a value that is not known


class NoNumber(BadCell):
    """A cell that is no number."""


def matrix(text: str, width: int, delimiter: str, decimal: str) -> FloatArray | None:
    """Lines that hold numbers and empty cells alone, shape (lines, width); None where they hold anything else.

    The fast way: numpy reads the lines. It says too little about what is wrong, so the caller looks
    again, cell by cell.
    """
    text = text.replace("\r\n", "\n")
    if '"' in text or "\r" in text or not text.strip() or (decimal != "." and "." in text):
        return None
    if decimal != ".":
        text = text.replace(decimal, ".")
    blanks = delimiter == BLANKS
    try:
        filled = text if blanks else _filled(text, delimiter)
        found = np.loadtxt(io.StringIO(filled), delimiter=None if blanks else delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
    return found if found.shape[1] == width else None


def column(cells: Sequence[str], decimal: str) -> FloatArray:
    """Numbers of a column, shape (n,). Empty cells, "nan", "NA" and the like are NaN.

    Raises:
        NoNumber: text, or groups of digits ("1_000", "1.000,5").
    """
    values = np.empty(len(cells))
    for index, cell in enumerate(cells):
        if "_" in cell or (decimal != "." and "." in cell):
            raise NoNumber(index, cell)
        try:
            values[index] = float(cell.replace(decimal, ".") or "nan")
        except ValueError:
            if cell.strip().lower() not in NOTHING:
                raise NoNumber(index, cell) from None
            values[index] = np.nan
    return values


def is_number(cell: str, decimal: str) -> bool:
    """Whether `column` takes a cell."""
    try:
        column([cell], decimal)
    except NoNumber:
        return False
    return True


def _filled(text: str, delimiter: str) -> str:
    """The text, with "nan" in the empty cells."""
    pair, end, start = delimiter * 2, f"{delimiter}\n", f"\n{delimiter}"
    if pair in text:
        text = text.replace(pair, f"{delimiter}nan{delimiter}").replace(pair, f"{delimiter}nan{delimiter}")
    if end in text or text.endswith(delimiter):
        text = f"{text}\n".replace(end, f"{delimiter}nan\n")
    if start in text or text.startswith(delimiter):
        text = f"\n{text}".replace(start, f"\nnan{delimiter}")
    return text
