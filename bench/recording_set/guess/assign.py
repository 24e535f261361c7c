"""Which column is which quantity: by their names, one column each; of several, the most direct one.

A user says of a column `NAME=QUANTITY[UNIT]`, such as `pos=position[deg]` or `mark=ignore`. A magnitude takes its sign
from another column: `i=current[A] by duty`.
"""

import re
from collections.abc import Mapping as MappingOf
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bench.recording_set.condition_columns import SAME
from bench.recording_set.conditions import KNOWN
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.evidence import is_clock
from bench.recording_set.guess.names import (
    DRIVE,
    LOAD,
    TAKEN,
    TARGET,
    UNITS_OF,
    Reading,
    is_weight,
    read_name,
    same_kind,
)
from bench.recording_set.mapping import STAMP
from bench.recording_set.text.dialect import is_stamp
from bench.recording_set.units import unit_named, units_of
from compensator.lab.recordings.recording import EVENT_COLUMN, FloatArray

IGNORE = "ignore"
_FORM = re.compile(r"(?P<name>.+)=(?P<quantity>[a-z_]+)(?:\[(?P<unit>[^\]]+)\])?(?: by (?P<sign>.+))?")
_OPTION = "--take"


@dataclass(frozen=True)
class Said:
    """What a user says of a column.

    Attributes:
        unit: None where none is said.
        sign_from: column whose sign it takes, where it is a magnitude.
    """

    column: str
    quantity: str
    unit: str | None
    sign_from: str | None = None


def read_said(texts: Sequence[str]) -> dict[str, Said]:
    """What was said, by column.

    Raises:
        RecordingSetError: not of that form, an unknown quantity or unit.
    """
    return {one.column: one for one in map(_read, texts)}


def _read(text: str) -> Said:
    match = _FORM.fullmatch(text.strip())
    if match is None:
        raise RecordingSetError(
            _OPTION, f"found '{text}'; wanted NAME=QUANTITY[UNIT], such as pos=position[deg] or mark=ignore"
        )
    quantity, unit = match["quantity"], match["unit"]
    if quantity != IGNORE and quantity not in TAKEN:
        wanted = ", ".join([*UNITS_OF, IGNORE]) + f"; of conditions that hold for a whole trial {', '.join(KNOWN)}"
        raise RecordingSetError(_OPTION, f"'{quantity}' of '{text}' is no quantity; wanted one of {wanted}")
    if unit is not None and unit != STAMP:
        known = unit_named(unit)
        allowed = TAKEN.get(quantity, ())
        if not allowed:
            raise RecordingSetError(_OPTION, f"{quantity} has no unit; leave '[{unit}]' of '{text}' out")
        if known is None or known.si not in allowed:
            names = ", ".join(name for si in allowed for name in units_of(si))
            raise RecordingSetError(_OPTION, f"'{unit}' of '{text}' is no unit of {quantity}; wanted one of {names}")
    if quantity in KNOWN and match["sign"] is not None:
        raise RecordingSetError(_OPTION, f"{quantity} has no sign; leave 'by {match['sign']}' of '{text}' out")
    return Said(match["name"], quantity, unit, match["sign"])


@dataclass(frozen=True)
class Assigned:
    """Which column is which quantity.

    Attributes:
        columns: quantity -> names of the columns; of a time in two columns, both.
        said: what a user says, by name.
        unused: column -> why it is not used.
        questions: where several columns are equally good.
        conditions: condition of a trial -> name of the column that holds it.
    """

    names: tuple[str, ...]
    columns: dict[str, tuple[str, ...]]
    readings: dict[str, Reading]
    said: MappingOf[str, Said]
    unused: dict[str, str]
    questions: tuple[str, ...]
    conditions: dict[str, str]


def assign(files: Sequence[Columns], said: MappingOf[str, Said]) -> Assigned:
    """The column of each quantity."""
    columns: Columns = {}
    for one in files:
        columns = one | columns  # of a column that several have, the first one's values
    columns = {name: columns[name] for one in files for name in one}
    named = [name for one in said.values() for name in (one.column, one.sign_from) if name is not None]
    missing = [name for name in named if name not in columns]
    if missing:
        raise RecordingSetError("--take", f"no column is called '{missing[0]}'; there are {', '.join(columns)}")
    readings = {name: read_name(name) for name in columns}
    everywhere = {name for name in columns if all(name in one for one in files)}
    candidates: dict[str, list[str]] = {}
    unused: dict[str, str] = {}
    for name, values in columns.items():
        quantity, why = _quantity(name, values, readings[name], said)
        if quantity:
            candidates.setdefault(quantity, []).append(name)
        else:
            unused[name] = why
    conditions = {quantity: candidates.pop(quantity) for quantity in KNOWN if quantity in candidates}
    _keep_constant(conditions, files, said, unused)
    _clock(columns, candidates, unused)
    chosen: dict[str, tuple[str, ...]] = {}
    questions = _measured_torque(candidates, readings, said)
    for quantity, names in candidates.items():
        wanted = [name for name in names if name in everywhere or name in said] or names
        best, tied = _best(quantity, wanted, columns, readings, said)
        chosen[quantity] = best
        unused |= {name: f"{' + '.join(best)} is the {quantity}" for name in names if name not in best}
        if tied:
            listed = ", ".join(f"'{name}'" for name in tied)
            option = f"--take '{tied[0]}={quantity}[{UNITS_OF[quantity][0]}]'"
            questions.append(f"{listed} could each be the {quantity}: say which one, such as {option}")
    held = {}
    for condition, (name, *others) in conditions.items():
        held[condition] = name
        unused |= dict.fromkeys(others, f"{name} is the {condition}")
    return Assigned(tuple(columns), chosen, readings, said, unused, tuple(questions), held)


def _quantity(name: str, values: object, reading: Reading, said: MappingOf[str, Said]) -> tuple[str, str]:
    """The quantity of a column, or "" and why it is not used."""
    if name in said:
        return ("", "as said") if said[name].quantity == IGNORE else (said[name].quantity, "")
    if name == EVENT_COLUMN:
        return "", "events: they are kept"
    if isinstance(values, list):
        texts = [text for text in values[:50] if text.strip()]
        stamps = bool(texts) and all(is_stamp(text) for text in texts)
        return ("time", "") if stamps and reading.quantity in ("time", "") else ("", "text")
    numbers = np.asarray(values)
    if not np.isfinite(numbers).any():
        return "", "empty"
    if reading.quantity or not is_weight(reading.words):
        return reading.quantity, "its name is not known"
    return "", f"its name has no unit of a mass; where it is the load, say --take '{name}={LOAD}[kg]'"


def _keep_constant(
    conditions: dict[str, list[str]], files: Sequence[Columns], said: MappingOf[str, Said], unused: dict[str, str]
) -> None:
    """Of the columns that may hold a condition, those that keep one value in each file, and those that were said."""
    for condition, names in list(conditions.items()):
        changing = [name for name in names if name not in said and not all(_is_constant(one, name) for one in files)]
        unused |= dict.fromkeys(changing, f"it changes within a trial, and {condition} has one value in each")
        told = [name for name in names if name in said]
        conditions[condition] = told + [name for name in names if name not in told and name not in changing]
        if not conditions[condition]:
            del conditions[condition]


def _is_constant(columns: Columns, name: str) -> bool:
    """Whether a column has one value, or is not there."""
    numbers = columns.get(name, np.empty(0))
    if isinstance(numbers, list):
        return False
    known = numbers[np.isfinite(numbers)]
    return not len(known) or float(np.ptp(known)) <= SAME * float(np.abs(known).max())


def _clock(columns: Columns, candidates: dict[str, list[str]], unused: dict[str, str]) -> None:
    """Where no name is one of a time: the only column that rises evenly."""
    if "time" in candidates:
        return
    rising = [name for name, values in columns.items() if name in unused and not isinstance(values, list)]
    rising = [name for name in rising if is_clock(np.asarray(columns[name]))]
    if len(rising) == 1:
        candidates["time"] = rising
        del unused[rising[0]]


def _measured_torque(
    candidates: dict[str, list[str]], readings: dict[str, Reading], said: MappingOf[str, Said]
) -> list[str]:
    """A torque that is "measured" is the effort where nothing else is; beside one of the motor it is the load's."""
    torques = candidates.get("torque", [])
    measured = [name for name in torques if "measured" in readings[name].words and not readings[name].words & DRIVE]
    others = [name for name in torques if name not in measured]
    if not measured or measured[0] in said or "load_torque" in candidates:
        return []
    if any(name in said or not readings[name].words & TARGET for name in others):
        candidates["torque"], candidates["load_torque"] = others, measured
        return []
    if not others and not candidates.keys() & {"current", "voltage", "duty"}:
        return []
    name = measured[0]
    options = " or ".join(f"--take '{name}={one}[N m]'" for one in ("torque", "load_torque"))
    return [f"'{name}' may be the torque of the motor, or of a sensor at the load: say {options}"]


def _best(
    quantity: str, names: list[str], columns: Columns, readings: dict[str, Reading], said: MappingOf[str, Said]
) -> tuple[tuple[str, ...], list[str]]:
    """The column of a quantity, and those that are as good."""
    told = [name for name in names if name in said]
    if told:
        return tuple(told) if quantity == "time" else (told[0],), told[1:] and told
    if quantity == "time" and (pair := _clock_pair(names, columns, readings)):
        return pair, []
    score = {name: readings[name].score for name in names}
    top = max(score.values())
    best = [name for name in names if score[name] == top]
    if len(best) == 1:
        return (best[0],), []
    if quantity == "time":
        return (best[0],), []
    same = all(np.array_equal(_array(columns[best[0]]), _array(columns[name]), equal_nan=True) for name in best[1:])
    return (best[0],), [] if same and not same_kind(best) else best


def _array(values: FloatArray | list[str]) -> NDArray[np.generic]:
    return np.asarray(values)


def _clock_pair(names: list[str], columns: Columns, readings: dict[str, Reading]) -> tuple[str, ...]:
    """Two columns that are one time: date and time of day as text, or seconds and their fractions."""
    texts = [name for name in names if isinstance(columns[name], list)]
    if len(texts) == 2:
        dates = [name for name in texts if not any(":" in text for text in columns[name][:5] if isinstance(text, str))]
        if len(dates) == 1:
            return (dates[0], next(name for name in texts if name != dates[0]))
    units = {unit.name: name for name in names if name not in texts and (unit := readings[name].unit)}
    for part in ("ns", "us"):
        whole, fraction = units.get("s"), units.get(part)
        if whole and fraction and not isinstance(columns[fraction], list):
            values = np.asarray(columns[fraction])
            if np.nanmin(values) >= 0.0 and np.nanmax(values) < (1e9 if part == "ns" else 1e6):
                return (whole, fraction)
    return ()
