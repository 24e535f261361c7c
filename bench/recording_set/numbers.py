"""Cells to numbers: float64 exactly, an empty cell is NaN."""

from collections.abc import Sequence

import numpy as np

from compensator.lab.recording import FloatArray


class NoNumber(ValueError):
    """A cell that is no number.

    Args:
        index: which of the cells.
        text: what it holds.
    """

    def __init__(self, index: int, text: str) -> None:
        super().__init__(text)
        self.index = index
        self.text = text


def numbers(cells: Sequence[str], decimal: str = ".") -> FloatArray:
    """Numbers of a column, shape (n,). Empty cells and "nan" are NaN.

    Args:
        cells: as they stand in the file.
        decimal: sign between units and tenths.

    Raises:
        NoNumber: text, digit groups ("1_000", "1.000,5").
    """
    signs = "".join(cells)
    if "_" in signs or (decimal != "." and "." in signs):
        bad = next(i for i, cell in enumerate(cells) if "_" in cell or (decimal != "." and "." in cell))
        raise NoNumber(bad, cells[bad])
    if decimal != ".":
        cells = [cell.replace(decimal, ".") for cell in cells]
    try:
        return _floats(cells)
    except ValueError:
        filled = [cell if cell and not cell.isspace() else "nan" for cell in cells]
    try:
        return _floats(filled)
    except ValueError:
        raise _first_bad(filled, decimal) from None


def _floats(cells: Sequence[str]) -> FloatArray:
    return np.fromiter(map(float, cells), dtype=np.float64, count=len(cells))


def _first_bad(cells: Sequence[str], decimal: str) -> NoNumber:
    for index, cell in enumerate(cells):
        try:
            float(cell)
        except ValueError:
            return NoNumber(index, cell.replace(".", decimal))
    raise AssertionError("every cell is a number")
