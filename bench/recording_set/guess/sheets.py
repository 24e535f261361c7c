"""The columns of files whose meaning is not known yet, read whole."""

from collections.abc import Sequence
from pathlib import Path

from bench.recording_set.container import open_container
from bench.recording_set.formats.column_table import Columns
from bench.recording_set.guess.guess import Sheet
from bench.recording_set.mapping import Mapping
from bench.recording_set.read import entries_of, table_of
from bench.recording_set.recording_csv import read_columns
from bench.recording_set.text.table import Table

PLAIN = Mapping()


def read_sheets(paths: Sequence[Path]) -> tuple[list[Sheet], list[str]]:
    """The columns of a folder, a zip or single files, and how the files were read, in words.

    Raises:
        RecordingSetError: not there, no tables, or one that cannot be read.
    """
    sheets, notes = [], []
    with open_container(*paths) as container:
        for entry in entries_of(container, PLAIN):
            table = table_of(container, entry, PLAIN)
            columns: Columns = read_columns(table) if isinstance(table, Table) else table.columns
            sheets.append(Sheet(table.place, columns, table.rate_hz))
            if table.told:
                notes.append(f"{table.place}: {table.told}")
    return sheets, notes
