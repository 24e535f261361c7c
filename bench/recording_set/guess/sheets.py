"""The columns of files whose meaning is not known yet, read whole."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bench.recording_set.checks import LARGEST
from bench.recording_set.container import Container, open_container
from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.guess import Sheet
from bench.recording_set.mapping import Mapping, Renamed
from bench.recording_set.read import entries_of, table_of
from bench.recording_set.recording_csv import read_columns
from bench.recording_set.text.table import Table
from bench.recording_set.trials_csv import OTHER_UNITS, TRIALS_FILE


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
