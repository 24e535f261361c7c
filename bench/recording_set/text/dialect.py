"""How a text file holds its table: sign between columns, decimal sign, and the line of the header.

Told by what most lines below the header have in common: the same number of cells, nearly all of them numbers. A header
is the text line above the first of them that has as many cells; what stands above it is the instrument's own preface.
"""

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

from bench.recording_set.text.stamps import LONGEST
from bench.recording_set.units import unit_named

BLANKS = " "  # as a delimiter: any number of blanks and tabs
DELIMITERS = (",", ";", "\t", "|", BLANKS)
COMMENTS = ("#", "%", "//", "!", "*")
FEWEST_LINES, MOST_LINES = 2, 200  # of numbers that are looked at
NUMERIC = 0.5  # of the cells of a line of numbers
LONGEST_RATE = 200  # characters: what is longer says no rate, and would be looked at for long
_NUMBER = re.compile(r"[+-]?(\d++(\.\d*+)?|\.\d++)([eE][+-]?\d++)?|[+-]?(nan|inf)", re.ASCII | re.IGNORECASE)
_COMMA = re.compile(r"\d,\d")
_STAMP = re.compile(r"[\dT:.,/+Z -]*\d[:/-]\d\d[\dT:.,/+Z -]*([AaPp]\.?[Mm]\.?)?|\d\d?\.\d\d?\.\d{4}[\d:., ]*")
_RATE = re.compile(
    r"(?:sampl\w*[ _]*(?:rate|freq\w*)?|rate|fs|abtast\w*)\W{0,4}(?P<value>[\d.,]+)\s*(?P<unit>k?hz)", re.IGNORECASE
)
_STEP = re.compile(
    r"\b(?:dt|ts|delta[ _]?[tx]|sampl\w*[ _]*(?:time|period))\W{0,4}(?P<value>[\d.,eE-]+)\s*(?P<unit>m?s)\b",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Dialect:
    """How a table is written.

    Attributes:
        delimiter: between columns; BLANKS for any blanks.
        decimal: decimal sign.
        header: the names of the columns, with their units where a line of units follows.
        header_line: its line, from 1; 0 where there is none and the columns were given numbers.
        first_line: the first line of numbers, from 1.
        rate_hz: what the preface says of the sampling; None where it says nothing.
    """

    delimiter: str = ","
    decimal: str = "."
    header: tuple[str, ...] = ()
    header_line: int = 1
    first_line: int = 2
    rate_hz: float | None = None


def dialect_of(lines: Sequence[str], delimiter: str | None = None, decimal: str | None = None) -> Dialect | None:
    """The dialect of a file that begins with these lines; None where no lines of numbers are found in them."""
    return _found(tuple(lines), delimiter, decimal)


# a file is read for its sheets, for the guess and for its recordings, and each time it is told anew how it is written
@lru_cache(64)
def _found(lines: tuple[str, ...], delimiter: str | None, decimal: str | None) -> Dialect | None:
    best, score = None, (0.0, 0.0)
    for sign in DELIMITERS if delimiter is None else (delimiter,):
        rows = [_cells(line, sign) for line in lines]
        for point in (".", ",") if decimal is None else (decimal,):
            if point == sign and not any('"' in line for line in lines):
                continue
            for read in (_without_end(rows), rows):
                block = _block(read, point)
                if block is None:
                    continue
                first, width, share, count = block
                named = _header(read, first, width, point)
                if read is rows and not (named[1] and named[0][-1]):
                    continue  # an empty last cell is a column only under a name
                # more columns of numbers under a header of as many names are no accident
                found = (share * width * (2.0 if named[1] else 1.0), count)
                if found > score:
                    best, score = Dialect(sign, point, named[0], named[1], first + 1), found
    return None if best is None else replace(best, rate_hz=_rate(lines[: best.first_line]))


def is_comment(text: str, delimiter: str = ",") -> bool:
    """Whether a line is a remark, by how it begins."""
    start = text.lstrip().lstrip('"')
    return start.startswith(COMMENTS) or (delimiter != ";" and start.startswith(";"))


def dialect_of_text(lines: Sequence[str], delimiter: str | None = None, decimal: str | None = None) -> Dialect:
    """The dialect of a table of text under a header in its first line, such as trials.csv."""
    header = next((index for index, line in enumerate(lines) if line.strip()), 0)
    line = lines[header] if lines else ""
    sign = delimiter or max(DELIMITERS[:4], key=lambda one: len(_cells(line, one)))
    point = decimal or ("," if sign != "," and any(_COMMA.search(one) for one in lines[header + 1 :]) else ".")
    return Dialect(sign, point, (), header + 1, header + 2)


def is_number(cell: str, decimal: str) -> bool:
    """Whether a cell is a number."""
    text = cell.strip()
    if decimal != ".":
        if "." in text:
            return False
        text = text.replace(decimal, ".")
    return _NUMBER.fullmatch(text) is not None


def is_stamp(cell: str) -> bool:
    """Whether a cell looks like date or time."""
    text = cell.strip()
    return len(text) <= LONGEST and _STAMP.fullmatch(text) is not None


def _cells(line: str, delimiter: str) -> list[str]:
    if delimiter == BLANKS:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=delimiter), [])
    except csv.Error:
        return []


def _without_end(rows: Sequence[list[str]]) -> list[list[str]]:
    """The rows without an empty last cell: a sign at the end of each line."""
    return [cells[:-1] if len(cells) > 1 and not cells[-1].strip() else cells for cells in rows]


def _block(rows: Sequence[list[str]], decimal: str) -> tuple[int, int, float, int] | None:
    """The first line of numbers, its cells, their share of numbers, and how many lines like it follow."""
    for first, cells in enumerate(rows):
        if not cells or not _is_data(cells, decimal):
            continue
        width = len(cells)
        following = [row for row in rows[first : first + MOST_LINES] if row and not is_comment(row[0])]
        alike = [row for row in following if len(row) == width and _is_data(row, decimal)]
        enough = len(alike) >= FEWEST_LINES and len(alike) >= 0.6 * len(following)
        if enough and not _is_preface(cells, alike, decimal):
            share = sum(_is_value(cell, decimal) for row in alike for cell in row) / (width * len(alike))
            return first, width, share, len(alike)
    return None


def _is_data(cells: Sequence[str], decimal: str) -> bool:
    """Whether a line holds values: numbers, for the most part, and a number or a time to begin with."""
    numbers = sum(is_number(cell, decimal) or is_stamp(cell) for cell in cells)
    values = numbers + sum(not cell.strip() for cell in cells)
    return numbers > 0 and values >= NUMERIC * len(cells) and not any("=" in cell or ":=" in cell for cell in cells[:1])


def _is_preface(cells: Sequence[str], alike: Sequence[list[str]], decimal: str) -> bool:
    """Whether a line has text where most others have values: "Interval,0.0005" of an instrument, not a row."""
    for cell, column in zip(cells, zip(*alike, strict=True), strict=True):
        values = sum(_is_value(one, decimal) for one in column if one.strip())
        if not _is_value(cell, decimal) and values > 0.5 * len(alike):
            return True
    return False


def _is_value(cell: str, decimal: str) -> bool:
    return not cell.strip() or is_number(cell, decimal) or is_stamp(cell)


def _header(rows: Sequence[list[str]], first: int, width: int, decimal: str) -> tuple[tuple[str, ...], int]:
    """The names of the columns, and their line; numbered columns, and 0, where none are there."""
    above = [index for index in range(first - 1, -1, -1) if rows[index] and any(map(str.strip, rows[index]))]
    texts = []
    for index in above[:2]:
        cells = _names(rows[index], width)
        if cells is None or any(is_number(cell, decimal) for cell in cells if cell):
            break
        texts.append((index, cells))
    if not texts:
        return tuple(f"column {number + 1}" for number in range(width)), 0
    index, names = texts[0]
    if len(texts) == 2:
        above_it, upper = texts[1]
        if _are_units(names):
            index = above_it
            names = [f"{name} {_bracketed(unit)}".strip() for name, unit in zip(upper, names, strict=True)]
        else:  # an instrument that names the kind of each column, then the column, or its unit where it has no name
            named = zip(upper, names, strict=True)
            names = [f"{name} {_bracketed(cell)}" if _is_unit_of(name, cell) else cell for name, cell in named]
    return tuple(_told_apart(names)), index + 1


def _is_unit_of(name: str, cell: str) -> bool:
    bare = cell.strip("[]() ")
    return bool(name) and unit_named(bare) is not None and unit_named(name) is None


def _told_apart(names: Sequence[str]) -> list[str]:
    """The names, each of those that come again with its number: "spare", "spare (2)"."""
    found: list[str] = []
    for name in names:
        number = names[: len(found)].count(name) + 1
        found.append(name if number == 1 or not name else f"{name} ({number})")
    return found


def _names(cells: Sequence[str], width: int) -> list[str] | None:
    """The cells of a header without the sign of a remark; None where there are not as many as columns."""
    found = [cell.strip().strip('"').strip() for cell in cells]
    for sign in COMMENTS:
        if found[0].startswith(sign):
            found[0] = found[0].removeprefix(sign).strip().strip('"')
            if not found[0]:
                found = found[1:]
            break
    return found if found and len(found) == width else None


def _are_units(cells: Sequence[str]) -> bool:
    told = [cell.strip("[]() ") for cell in cells if cell.strip("[]() ")]
    return bool(told) and sum(unit_named(cell) is not None for cell in told) >= 0.6 * len(told)


def _bracketed(unit: str) -> str:
    bare = unit.strip("[]() ")
    return f"[{bare}]" if bare else ""


def _rate(preface: Sequence[str]) -> float | None:
    for line in (each[:LONGEST_RATE] for each in preface):
        if match := _RATE.search(line):
            value = _value(match["value"])
            return None if value is None else value * (1e3 if match["unit"].lower() == "khz" else 1.0)
        if match := _STEP.search(line):
            value = _value(match["value"])
            return None if not value else 1.0 / (value * (1e-3 if match["unit"].lower() == "ms" else 1.0))
    return None


def _value(text: str) -> float | None:
    try:
        return float(text.replace(",", ".").rstrip("."))
    except ValueError:
        return None
