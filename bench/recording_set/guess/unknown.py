"""Files of an unknown bench as a recording set: guessed where nobody wrote a mapping, or refused with a question."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from bench.config.rig import Rig, sensor_turns
from bench.recording_set.checks import LARGEST
from bench.recording_set.conditions import OTHER_UNITS
from bench.recording_set.container import Container, open_container
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.guess import NOTHING, Guess, Known, Sheet, guess_mapping
from bench.recording_set.mapping import Mapping, Renamed
from bench.recording_set.read import (
    MAPPING_FILE,
    RIG_FILE,
    TELL_ARM,
    entries_of,
    name_of_set,
    own_mapping,
    read_recording_set,
    read_rig_of,
    table_of,
)
from bench.recording_set.recording_csv import read_columns
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.text.table import Table
from bench.recording_set.trials_csv import TRIALS_FILE
from compensator.lab.recordings.recording import CHANNELS, EVENT_COLUMN


def read_sheets(paths: Sequence[Path]) -> tuple[list[Sheet], dict[str, str | Renamed], list[str]]:
    """The columns of a folder, a zip or single files; those of trials.csv in SI; and how the files were read, in words.

    Raises:
        RecordingSetError: not there, no tables, or one that cannot be read.
    """
    sheets, notes = [], []
    with open_container(*paths) as container:
        renamed = _trials_columns(container)
        plain = Mapping(trials_columns=renamed)
        for entry in entries_of(container, plain):
            table = table_of(container, entry, plain)
            columns: Columns = read_columns(table) if isinstance(table, Table) else table.columns
            sheets.append(Sheet(table.place, _possible(columns), table.rate_hz, entry.file))
            if table.told:
                notes.append(f"{table.place}: {table.told}")
    return sheets, renamed, notes


def _possible(columns: Columns) -> Columns:
    """The same; numbers that are no measurement tell nothing of units."""
    return {
        name: values if isinstance(values, list) else np.where(np.abs(values) > LARGEST, np.nan, values)
        for name, values in columns.items()
    }


def _trials_columns(container: Container) -> dict[str, str | Renamed]:
    """Conditions of trials.csv in other units, and the column of files where it has another name."""
    if not container.has(TRIALS_FILE):
        return {}
    table = Table(container, TRIALS_FILE, numeric=False)
    found: dict[str, str | Renamed] = {}
    for name in table.header:
        if known := OTHER_UNITS.get(name.lower()):
            found[known[0]] = Renamed(source=name, scale=known[1])
    if "file" not in table.header:
        rows = [cells for chunk in table.chunks() for _, cells in chunk.records(len(table.header))]
        names = [name for at, name in enumerate(table.header) if rows and all(container.has(row[at]) for row in rows)]
        found |= {"file": names[0]} if names else {}
    return found


def guess_of(paths: Sequence[Path], rig: Rig | None, known: Known) -> tuple[Guess, Rig, tuple[str, ...]]:
    """What the columns of files may be, the rig that is assumed, and how the files were read.

    What the import of this guess refuses in the columns is a question. A load is confirmed in the mapping instead.

    Raises:
        RecordingSetError: a file that cannot be read, or a column that is not there.
    """
    guess, rig, notes = _guess_of(paths, rig, known)
    if not guess.questions:
        try:
            read_recording_set(
                paths, guess.mapping, rig.model_copy(update={"horizontal": True})
            )  # there no load counts
        except RecordingSetError as error:
            guess = replace(guess, questions=(f"an import refuses this: {error}",))
    if "load_kg" in guess.mapping.conditions and not _is_arm_told(guess.mapping, rig):
        note = f"a load is part of the model only where somebody tells where it hangs; {TELL_ARM}"
        guess = replace(guess, notes=(*guess.notes, note))
    return guess, rig, notes


def _is_arm_told(mapping: Mapping, rig: Rig) -> bool:
    """Whether it is told where a load hangs, or a linear joint has no arm."""
    return rig.joint != "rotary" or rig.arm.length_m is not None or "arm_m" in mapping.conditions


def _guess_of(paths: Sequence[Path], rig: Rig | None, known: Known) -> tuple[Guess, Rig, tuple[str, ...]]:
    own = rig or _own_rig(paths)
    with open_container(*paths) as container:
        lists_trials = container.has(TRIALS_FILE)
    if known.counts_per_turn is None and own is not None and own.sensor.counts_per_turn is not None:
        known = replace(known, counts_per_turn=own.sensor.counts_per_turn * (sensor_turns(own) or 1.0))
    if own is not None and own.gear.ratio is not None:
        known = replace(known, gear_ratio=own.gear.ratio)
    if own is not None:
        known = replace(known, rig_supply_v=own.supply.voltage_v)
    sheets, renamed, notes = read_sheets(paths)
    guess = guess_mapping(sheets, known)
    mapping = guess.mapping.model_copy(update={"trials_columns": renamed})
    guess = replace(guess, mapping=mapping, files=() if lists_trials else guess.files)  # else trials.csv tells them
    return guess, own or Rig(name=name_of_set(list(paths)), joint=guess.joint), tuple(notes)


def read_unknown(
    paths: Sequence[Path], rig: Rig | None, known: Known, mapping: Mapping | None = None
) -> tuple[RecordingSet, Guess | None]:
    """Files of any bench; without a mapping, given or brought along by the set, it is guessed. So is a missing rig.

    A recording set, or a file of one, tells what its columns are: it is read as an import reads it, and not guessed.

    Raises:
        RecordingSetError: what `guess_of` refuses, a question that has to be answered first, or a value at fault.
    """
    paths = [Path(one).absolute() for one in paths]
    with open_container(*paths) as container:
        told = mapping or (own_mapping(container) if container.has(MAPPING_FILE) else None)
    if told is not None:
        if known != NOTHING:
            message = "tells what each column is: put it there, and leave --take and the like out"
            raise RecordingSetError(MAPPING_FILE if mapping is None else "the mapping", message)
        linear = any(f"{name}_m" in told.columns for name in ("position", "target"))
        assumed = Rig(name=name_of_set(paths), joint="linear" if linear else "rotary")
        return read_recording_set(paths, mapping, rig or _own_rig(paths) or assumed), None
    if known == NOTHING and (own := _as_recording_set(paths, rig)) is not None:
        return own, None
    guess, rig, _ = _guess_of(paths, rig, known)
    check_answered(guess)
    return read_recording_set(paths, guess.mapping, rig), guess


def _as_recording_set(paths: Sequence[Path], rig: Rig | None) -> RecordingSet | None:
    """What `write_recording_set` wrote, or files of it; None where it is something else, or is not what it says."""
    try:
        with open_container(*paths) as container:
            entries = entries_of(container, Mapping())
            if not all(entry.file.endswith(".csv") for entry in entries):  # other formats would be read whole here
                return None
            headers = [table_of(container, entry, Mapping()).header for entry in entries]
            lists_trials = container.has(TRIALS_FILE) and container.has(RIG_FILE)
        names = {name for header in headers for name in header}
        if not names <= {*CHANNELS, EVENT_COLUMN} or not (lists_trials or EVENT_COLUMN in names):
            return None
        return read_recording_set(paths, None, rig or _own_rig(paths) or Rig(name=name_of_set(paths)))
    except RecordingSetError:
        return None


def check_answered(guess: Guess) -> None:
    """Refuse a guess that leaves questions, which are of all its files together.

    Raises:
        RecordingSetError: names every question and the option that answers it.
    """
    if not guess.questions:
        return
    first, *others = guess.places
    name = f"{first} and {len(others)} more" if len(others) > 1 else " and ".join(guess.places)
    if len(guess.questions) == 1:
        raise RecordingSetError(name, guess.questions[0])
    listed = "".join(f"\n- {question}" for question in guess.questions)
    raise RecordingSetError(name, f"{len(guess.questions)} things have to be said first:{listed}")


def _own_rig(paths: Sequence[Path]) -> Rig | None:
    with open_container(*paths) as container:
        return read_rig_of(container) if container.has(RIG_FILE) else None
