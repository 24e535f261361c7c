"""The time of unknown files: in which unit, of one column or two, and whether it rises."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.assign import Assigned
from bench.recording_set.guess.evidence import clock_units
from bench.recording_set.mapping import STAMP, Column, Stamps
from bench.recording_set.text.stamps import NoStamp, seconds_of
from bench.recording_set.units import UNITS, unit_named
from compensator.lab.recordings.recording import FloatArray

COARSE = 0.2  # share of times that repeat, from which the clock is coarse rather than lines repeated
_FRACTIONS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


@dataclass
class Clock:
    """The time of some files.

    Attributes:
        column: how time_s is made; None where no column is a time, or its unit is asked.
        time_s: of each file, from its own start; None where it is not known.
        stamps: what is done about times that do not rise.
        why: column -> why it has its unit.
    """

    column: Column | None = None
    time_s: list[FloatArray | None] = field(default_factory=list)
    stamps: Stamps = "rise"
    why: dict[str, str] = field(default_factory=dict)
    questions: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def clock_of(files: Sequence[Columns], assigned: Assigned, rate_hz: float | None) -> Clock:
    """The time of some files."""
    clock = Clock()
    names = assigned.columns.get("time")
    if names is None:
        lengths = [len(next(iter(columns.values()))) for columns in files]
        clock.time_s = [None if rate_hz is None else np.arange(length) / rate_hz for length in lengths]
        return clock
    clock.column = _column(files, names, assigned, clock)
    for columns in files:
        time_s = _seconds(columns, clock.column)
        clock.time_s.append(time_s)
        if time_s is not None:
            _order(time_s, clock)
    return clock


def _column(files: Sequence[Columns], names: tuple[str, ...], assigned: Assigned, clock: Clock) -> Column | None:
    first = next((columns[names[0]] for columns in files if names[0] in columns), [])
    if isinstance(first, list):
        clock.why |= dict.fromkeys(names, "date and time")
        return Column(source=list(names) if len(names) > 1 else names[0], unit=STAMP)
    if len(names) > 1:
        clock.why |= dict.fromkeys(names, "seconds and their fractions")
        units = [assigned.readings[name].unit for name in names]
        return Column(source=list(names), scale=[_FRACTIONS.get(unit.name, 1.0) if unit else 1.0 for unit in units])
    return _of_numbers(names[0], first, assigned, clock)


def _of_numbers(name: str, values: FloatArray, assigned: Assigned, clock: Clock) -> Column | None:
    said = assigned.said.get(name)
    if said is not None and said.unit is not None:
        clock.why[name] = "as said"
        return Column(source=name, unit=said.unit)
    unit, possible = assigned.readings[name].unit, clock_units(values)
    unit = unit if unit is not None and unit.si == "s" else None
    if unit is not None and (unit.name in possible or not possible):
        clock.why[name] = "its name"
        return Column(source=name, unit=None if unit.name == "s" else unit.name)
    if unit is None and len(possible) == 1:
        clock.why[name] = f"in {possible[0]} the sampling is possible"
        return Column(source=name, unit=possible[0])
    step = float(np.nanmedian(np.abs(np.diff(values))))
    options = " or ".join(f"--take '{name}=time[{one}]'" for one in (possible or ["s", "ms"]))
    clock.questions.append(f"'{name}' has steps of {step:.4g}, and its unit is not sure: say {options}")
    return None


def _seconds(columns: Columns, column: Column | None) -> FloatArray | None:
    """The time of a file from its start; None where it lacks the column, or holds something else."""
    if column is None or not all(name in columns for name in column.sources):
        return None
    if column.is_stamp:
        try:
            return seconds_of([" ".join(map(str, one)) for one in zip(*map(columns.get, column.sources), strict=True)])
        except NoStamp:
            return None  # reading it says where
    unit = unit_named(column.unit or "s") or UNITS["s"]
    total = np.zeros(len(columns[column.sources[0]]))
    for name, scale in zip(column.sources, column.scales(), strict=True):
        values = columns[name]
        if isinstance(values, list):
            return None
        total += (values - values[0]) * scale * unit.factor
    return total


def _order(time_s: FloatArray, clock: Clock) -> None:
    """What is to be done about times that repeat or run backwards."""
    steps = np.diff(time_s)
    if (steps > 0.0).all() or not np.isfinite(time_s).all():
        return
    coarse = float(np.mean(steps == 0.0)) > COARSE and bool((steps >= 0.0).all())
    clock.stamps = "spread" if coarse or clock.stamps == "spread" else "sort"
    done = (
        "the lines of one time are laid evenly over the step to the next"
        if coarse
        else "the lines are put in order, and the first of each time is kept"
    )
    repeated, back = int(np.count_nonzero(steps == 0.0)), int(np.count_nonzero(steps < 0.0))
    clock.notes.append(f"times repeat {repeated} times and run backwards {back} times: {done}")
