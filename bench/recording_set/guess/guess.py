"""From the tables of an unknown bench to a mapping: which column is which channel, in which unit, and why."""

import json
from collections.abc import Mapping as MappingOf
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import tomli_w

from bench.recording_set.conditions import KNOWN
from bench.recording_set.formats.column_table import Columns, listed
from bench.recording_set.guess.assign import Assigned, Said, assign
from bench.recording_set.guess.evidence import clock_units, rises
from bench.recording_set.guess.names import UNITS_OF, is_named_by
from bench.recording_set.guess.units_told import Units
from bench.recording_set.mapping import ConditionColumn, Mapping
from compensator.lab.recordings.recording import CHANNELS, FloatArray

SIGNED = ("duty", "voltage", "current_command", "torque", "force", "current")  # of the drive, the nearest first
EITHER_WAY = 0.1  # share of the samples on the rarer side of 0, from which a column is of both signs
BELOW = 0.02  # of the largest value: an offset of a sensor, and no sign
EFFORTS = ("torque", "force", "current", "voltage", "duty")


def magnitude_questions(files: list[Columns], assigned: Assigned) -> list[str]:
    """Efforts that are never below 0, while the drive pushes both ways; each question names its option."""
    found = []
    for quantity in ("current", "torque", "force"):
        name = assigned.columns.get(quantity, ("",))[0]
        if name in assigned.said or not _never_below(_values(files, name)):
            continue
        other = next((one for one in _others(assigned, name) if _both_ways(_values(files, one))), None)
        if other is not None:
            plain = f"{name}={quantity}[{UNITS_OF[quantity][0]}]"
            found.append(
                f"'{name}' is never below 0, while '{other}' is of both signs: say --take '{plain} by {other}' where "
                f"it is a magnitude, else --take '{plain}'"
            )
    return found


def _others(assigned: Assigned, name: str) -> list[str]:
    return [names[0] for one in SIGNED if (names := assigned.columns.get(one)) and names[0] != name]


def _values(files: list[Columns], name: str) -> FloatArray:
    arrays = [columns[name] for columns in files if name in columns]
    numbers = [np.asarray(one) for one in arrays if not isinstance(one, list)]
    values: FloatArray = np.concatenate(numbers) if numbers else np.array([])
    return values[np.isfinite(values)]


def _never_below(values: FloatArray) -> bool:
    return len(values) > 0 and float(values.max()) > 0.0 and float(values.min()) >= -BELOW * float(values.max())


def _both_ways(values: FloatArray) -> bool:
    return len(values) > 0 and min(float(np.mean(values > 0.0)), float(np.mean(values < 0.0))) >= EITHER_WAY


@dataclass(frozen=True)
class Sheet:
    """The columns of one file. Attributes: its place, columns, what it says of the sampling rate [Hz], and its name."""

    place: str
    columns: Columns
    rate_hz: float | None = None
    file: str = ""


@dataclass(frozen=True)
class Taken:
    """What a column is taken for.

    Attributes:
        channel: of the recording, or condition of the trial; "" where it is not used.
        low, high: of its values, in that unit; None of text.
        outline: some of its values over time, in that unit; empty of text.
    """

    column: str
    channel: str
    unit: str
    low: float | None
    high: float | None
    why: str
    outline: tuple[float, ...] = ()


@dataclass(frozen=True)
class Guess:
    """A proposal.

    Attributes:
        mapping: as far as it is known; complete where nothing is asked.
        taken: every column, in the order of the file.
        questions: what a person has to say first; each names its option.
        places: of the files that were looked at, as their user knows them.
    """

    mapping: Mapping
    joint: Literal["rotary", "linear"]
    taken: tuple[Taken, ...]
    questions: tuple[str, ...]
    notes: tuple[str, ...]
    files: tuple[str, ...] = ()
    places: tuple[str, ...] = ()


@dataclass(frozen=True)
class Known:
    """What a user tells of files besides their columns.

    Attributes:
        rate_hz: of the samples, where no column is a time.
        supply_v: where no column holds it.
        gear_ratio, rig_supply_v: of the rig, where that tells them.
    """

    said: MappingOf[str, Said]
    counts_per_turn: float | None = None
    rate_hz: float | None = None
    supply_v: float | None = None
    gear_ratio: float | None = None
    rig_supply_v: float | None = None


NOTHING = Known({})


def guess_mapping(sheets: Sequence[Sheet], known: Known = NOTHING) -> Guess:
    """What the columns of some files of one bench may be."""
    assigned = assign([sheet.columns for sheet in sheets], known.said)
    rate_hz = None if "time" in assigned.columns else known.rate_hz or sheets[0].rate_hz
    units = Units([sheet.columns for sheet in sheets], assigned, known.counts_per_turn, rate_hz, known.gear_ratio)
    made = {quantity: units.column_of(quantity, names) for quantity, names in assigned.columns.items()}
    columns = {units.channel_of(quantity): column for quantity, column in made.items() if column is not None}
    conditions = {condition: _held(name, assigned) for condition, name in assigned.conditions.items()}
    used = {name for column in columns.values() for name in column.sources} | set(assigned.conditions.values())
    known, supply = _with_supply_of_rig(known, assigned)
    mapping = Mapping(
        columns=columns,
        conditions=conditions,
        ignore="rest" if set(assigned.names) - used else [],
        rate_hz=rate_hz,
        stamps=units.clock.stamps,
        counts_per_turn=known.counts_per_turn,
        constants={} if known.supply_v is None else {"supply_v": known.supply_v},
        position_from_speed="position" not in assigned.columns and "velocity" in assigned.columns,
    )
    notes = [*units.notes, *supply]
    if mapping.position_from_speed:
        notes.append("no column is a position: it is the integral of the speed, from 0 in each trial")
    taken = tuple(_taken(name, mapping, units, assigned) for name in assigned.names)
    unsigned = magnitude_questions([sheet.columns for sheet in sheets], assigned)
    missing = _missing(sheets, assigned, known, rate_hz)
    questions = (*assigned.questions, *units.questions, *unsigned, *missing, *_other_columns(sheets, assigned))
    joint: Literal["rotary", "linear"] = "linear" if units.joint == "linear" else "rotary"
    files, places = tuple(sheet.file for sheet in sheets), tuple(sheet.place for sheet in sheets)
    return Guess(mapping, joint, taken, questions, tuple(notes), files, places)


def _other_columns(sheets: Sequence[Sheet], assigned: Assigned) -> list[str]:
    """Files that the columns of the others do not read: one mapping would refuse them."""
    groups = (("time",), ("position", "velocity"), EFFORTS)
    wanted = [[name for name in group if name in assigned.columns] for group in groups]
    return [
        f"{sheet.place} has other columns than the others ({listed(sheet.columns)}): files whose columns "
        "differ are guessed one by one, each with a --mapping of its own"
        for sheet in sheets
        if any(group and not any(_has(sheet, name, assigned.columns[name]) for name in group) for group in wanted)
    ]


def _has(sheet: Sheet, quantity: str, names: tuple[str, ...]) -> bool:
    """Whether a file has the columns of a quantity, or one that needs no mapping."""
    own = [name for name in sheet.columns if name in CHANNELS and name.partition("_")[0] == quantity]
    return bool(own) or all(name in sheet.columns for name in names)


def _rising(sheets: Sequence[Sheet], assigned: Assigned) -> str:
    """The option that takes the first column that never falls, and that no word names, for the time."""
    for name in assigned.names:
        reading, found = assigned.readings[name], [one.columns[name] for one in sheets if name in one.columns]
        numbers = [np.asarray(one) for one in found if not isinstance(one, list)]
        if not is_named_by(reading.words, reading.quantity) and numbers and all(map(rises, numbers)):
            return f"--take '{name}=time[{(clock_units(numbers[0]) or ['s'])[0]}]', which never falls"
    return "--take 'NAME=time[ms]'"


def _with_supply_of_rig(known: Known, assigned: Assigned) -> tuple[Known, list[str]]:
    """The same with the supply of the rig, and a note of it, where the duty needs one and nothing else tells it."""
    needed = set(EFFORTS) & set(assigned.columns) == {"duty"} and "supply" not in assigned.columns
    if not needed or known.supply_v is not None or known.rig_supply_v is None:
        return known, []
    note = f"the supply is {known.rig_supply_v:g} V throughout, as the rig says ([supply] voltage_v)"
    return replace(known, supply_v=known.rig_supply_v), [note]


def _missing(sheets: Sequence[Sheet], assigned: Assigned, known: Known, rate_hz: float | None) -> list[str]:
    """What every study needs."""
    there = listed(assigned.names)
    efforts = set(EFFORTS) & set(assigned.columns)
    found = []
    if "time" not in assigned.columns and rate_hz is None:
        found.append(
            f"no column is a time (there are {there}): say how many samples a second, --rate-hz 1000, or which it is, "
            + _rising(sheets, assigned)
        )
    if not {"position", "velocity"} & set(assigned.columns):
        found.append(f"no column is a position or a speed (there are {there}): say --take 'NAME=position[deg]'")
    if not efforts:
        found.append(
            f"no column is an effort: torque, force, current, voltage or duty (there are {there}): say "
            "--take 'NAME=current[A]'"
        )
    elif efforts == {"duty"} and "supply" not in assigned.columns and known.supply_v is None:
        found.append(
            "the duty is an effort only with the supply: say which column it is, --take 'NAME=supply[V]', or its "
            "voltage, --supply-v 12, or in a rig [supply] voltage_v = 12"
        )
    return found


def _held(name: str, assigned: Assigned) -> ConditionColumn:
    """How a condition is made of a column: in the unit that is said, else in that of its name."""
    if name in assigned.said:
        return ConditionColumn(source=name, unit=assigned.said[name].unit)
    unit = assigned.readings[name].unit
    return ConditionColumn(source=name, unit=None if unit is None or unit.name == unit.si else unit.name)


def _taken(name: str, mapping: Mapping, units: Units, assigned: Assigned) -> Taken:
    low, high = units.range_of(name) or (None, None)
    outline = units.outline_of(name)
    for condition, held in mapping.conditions.items():
        if name == held.source:
            why = "as said" if name in assigned.said else "its name; it keeps one value in each trial"
            return Taken(name, condition, held.unit or KNOWN[condition], low, high, why, outline)
    for channel, column in mapping.columns.items():
        if name in column.sources:
            unit = column.unit or CHANNELS[channel].unit
            return Taken(name, channel, unit, low, high, units.why.get(name, "its name"), outline)
    return Taken(name, "", "", low, high, assigned.unused.get(name) or "it is asked about", outline)


def mapping_text(mapping: Mapping, notes: tuple[str, ...] = (), files: Sequence[str] = ()) -> str:
    """The text of a mapping.toml: what differs from the defaults, with remarks at its head.

    Args:
        mapping: of the columns.
        notes: the remarks.
        files: that hold a trial each; of these a comment at the end shows how load and arm are told.
    """
    values = mapping.model_dump(mode="json", by_alias=True, exclude_defaults=True, exclude_none=True)
    plain = {name: value for name, value in values.items() if not isinstance(value, dict | list)}
    tables = {name: value for name, value in values.items() if name not in plain}
    head = "".join(f"# {note}\n" for note in notes)
    text = tomli_w.dumps(plain | tables).replace(POSITION, POSITION + ZERO_COMMENT if _has_zero(mapping) else POSITION)
    return head + text + _conditions_comment(files, mapping)


POSITION = "[columns.position_rad]\n"
ZERO_COMMENT = """\
# 0 has to be where the arm hangs straight down: gravity is taken as A sin(position). Where the log has another zero,
# add the position that the joint has there, in rad whatever the unit of the column, here and in target_rad. Of a log
# that is 0 at the level arm:
# offset = 1.5708
"""


def _has_zero(mapping: Mapping) -> bool:
    """Whether the angle is taken from a column, and nobody told where its zero lies."""
    column = mapping.columns.get("position_rad")
    return column is not None and column.offset == 0.0


CONDITIONS_COMMENT = """
# Load and arm of each trial, where they are known. Conditions also tell, where it is so:
#   waveform = "slow sine"   which motion it is
#   repeat = 2               1, 2, .. of the trials that run one motion under equal conditions
#   session_s = 300          from the start of the session to that of the trial: warm-up goes by it
# Take the # away from all of these: all files are listed then.
"""


def _conditions_comment(files: Sequence[str], mapping: Mapping) -> str:
    if not files:
        return ""
    examples = {"load_kg": 0.1, "arm_m": 0.5}
    told = ", ".join(f"{name} = {value:g}" for name, value in examples.items() if name not in mapping.conditions)
    conditions = told or 'waveform = "slow sine"'
    names = [json.dumps(file, ensure_ascii=False) for file in files]
    blocks = [f"# [[trials]]\n# file = {name}\n# conditions = {{ {conditions} }}\n" for name in names]
    return CONDITIONS_COMMENT + "".join(blocks)
