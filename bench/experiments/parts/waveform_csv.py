"""A waveform out of a CSV: times and positions, currents or duties, as somebody typed or computed them."""

import csv
import io
from dataclasses import dataclass
from math import isfinite, nan

import numpy as np

from bench.config.quantities import unit_of
from bench.errors import ParameterError
from bench.experiments.parts.signal_play import Quantity
from compensator.lab.recordings.recording import FloatArray

TIMES = ("t_s", "time_s")
QUANTITIES: tuple[Quantity, ...] = ("position_rad", "current_a", "duty")
WANTED = "t_s and one of position_rad, current_a, duty"
LONGEST_S = 3600.0
FEWEST_ROWS = 2


@dataclass(frozen=True, slots=True)
class Waveform:
    """What the file says.

    Attributes:
        time_s: rising, from 0, shape (n,).
        values: shape (n,).
    """

    quantity: Quantity
    time_s: FloatArray
    values: FloatArray

    def resampled(self, period_s: float) -> FloatArray:
        """Values at every control period, the first and the last row included, shape (m,).

        Positions by a monotone cubic (Fritsch, Carlson 1980): smooth, and it overshoots no row. Currents and duties
        by straight lines.
        """
        cycles = np.arange(round(float(self.time_s[-1]) / period_s) + 1) * period_s
        cycles = np.minimum(cycles, self.time_s[-1])
        if self.quantity == "position_rad":
            from scipy.interpolate import PchipInterpolator  # imported when needed: every command starts with this file

            return np.asarray(PchipInterpolator(self.time_s, self.values)(cycles))
        return np.asarray(np.interp(cycles, self.time_s, self.values))


def read_waveform(text: str, source: str) -> Waveform:
    """Read the text of a CSV with the columns t_s (or time_s) and one of position_rad, current_a, duty.

    Raises:
        ParameterError: naming file, line and column, what was found and what is wanted.
    """
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    try:
        rows = [(reader.line_num, [cell.strip() for cell in cells]) for cells in reader if any(map(str.strip, cells))]
    except csv.Error as error:
        raise ParameterError(f"{source}, line {reader.line_num}: {error}; wanted cells between commas") from error
    if not rows:
        raise ParameterError(f"{source}: is empty; wanted a header, {WANTED}, and rows below it")
    line, header = rows[0]
    time_name, quantity = _columns(header, f"{source}, line {line}")
    table = np.array([_row(cells, header, (time_name, quantity), f"{source}, line {line}") for line, cells in rows[1:]])
    if len(table) < FEWEST_ROWS:
        raise ParameterError(f"{source}: found {len(table)} rows below the header; wanted at least {FEWEST_ROWS}")
    time_s = table[:, 0] - table[0, 0]
    _check_time(time_s, [f"{source}, line {line}, column {time_name}" for line, _ in rows[1:]])
    return Waveform(quantity, time_s, table[:, 1].copy())


def _columns(header: list[str], place: str) -> tuple[str, Quantity]:
    """The name of the time, and what is played."""
    times = [name for name in TIMES if name in header]
    quantities = [name for name in QUANTITIES if name in header]
    unknown = [name for name in header if name not in (*TIMES, *QUANTITIES)]
    if len(times) != 1 or len(quantities) != 1 or unknown or len(header) != 2:
        raise ParameterError(f"{place}: found the columns {', '.join(header)[:200]}; wanted {WANTED}")
    return times[0], quantities[0]


def _row(cells: list[str], header: list[str], names: tuple[str, str], place: str) -> tuple[float, float]:
    if len(cells) != len(header):
        raise ParameterError(f"{place}: found {len(cells)} cells; wanted {len(header)}, one per column of the header")
    time_s, value = (_number(cells[header.index(name)], f"{place}, column {name}", unit_of(name)) for name in names)
    if names[1] == "duty" and abs(value) > 1.0:
        raise ParameterError(f"{place}, column duty: found {value:g}; wanted a share of the supply, -1 .. 1")
    return time_s, value


def _number(cell: str, place: str, unit: str) -> float:
    try:
        value = float(cell)
    except ValueError:
        value = nan
    if not isfinite(value) or "_" in cell:
        wanted = f"a finite number{f' in {unit}' if unit else ''}, with a point"
        raise ParameterError(f"{place}: found '{cell[:40]}'; wanted {wanted}")
    return value


def _check_time(time_s: FloatArray, places: list[str]) -> None:
    """Times since the first row: rising, and not for ever."""
    wrong = np.flatnonzero(np.diff(time_s) <= 0.0)
    if len(wrong):
        row = int(wrong[0]) + 1
        raise ParameterError(
            f"{places[row]}: found a time {time_s[row - 1] - time_s[row]:g} s before that of the row above; "
            "wanted a time that rises from row to row"
        )
    if time_s[-1] > LONGEST_S:
        raise ParameterError(
            f"{places[-1]}: lasts {time_s[-1]:g} s; allowed is at most {LONGEST_S:g} s. Are milliseconds meant?"
        )
