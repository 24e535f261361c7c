"""Read a recording set: a folder, a zip, or a single CSV."""

import zipfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from bench.config.rig import Rig
from bench.recording_set.container import Container, check_name, open_container
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.mapping import Mapping
from bench.recording_set.recording_csv import read_recording_csv
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.text.table import Table, place
from bench.recording_set.text.toml_file import MOST_BYTES, parse_toml
from bench.recording_set.trials_csv import (
    DEFAULT_KIND,
    TRIALS_FILE,
    TrialEntry,
    condition_problem,
    name_of,
    read_trials_csv,
)
from compensator.lab.recordings.recording import Recording

RIG_FILE = "rig.toml"


def read_recording_set(path: Path, mapping: Mapping | None = None, rig: Rig | None = None) -> RecordingSet:
    """Read and check a whole recording set.

    Args:
        path: a folder, a zip of one, or a single CSV.
        mapping: for files of another shape.
        rig: instead of the set's own rig.toml.

    Raises:
        RecordingSetError: naming file, line and column, what was found and what is wanted.
    """
    path = Path(path).absolute()
    mapping = mapping or Mapping()
    with open_container(path) as container:
        rig = rig or _read_rig(container)
        entries = _entries(container, mapping)
        tables = [_table(container, entry, mapping) for entry in entries]
        _check_mapping_is_used(container, mapping, tables)
        recordings = [_read(entry, table, mapping) for entry, table in zip(entries, tables, strict=True)]
    return RecordingSet(path.stem if path.is_file() else path.name, rig, recordings)


def _read_rig(container: Container) -> Rig:
    if not container.has(RIG_FILE):
        message = 'is not there; write one with at least: name = "...", or name a rig file of your own'
        if container.path.is_file() and not zipfile.is_zipfile(container.path):
            raise RecordingSetError(container.path.name, "a single CSV has no rig; name one with --rig rig.toml")
        raise RecordingSetError(place(container, RIG_FILE), message)
    with container.open(RIG_FILE) as file:
        return parse_toml(file.read(MOST_BYTES + 1), Rig, place(container, RIG_FILE))


def _entries(container: Container, mapping: Mapping) -> list[TrialEntry]:
    if container.has(TRIALS_FILE):
        if mapping.trials:
            message = "is there, and the mapping lists trials too; leave [[trials]] out of the mapping"
            raise RecordingSetError(place(container, TRIALS_FILE), message)
        return read_trials_csv(Table(container, TRIALS_FILE, mapping.delimiter), mapping)
    if mapping.trials:
        return _mapped(mapping)
    files = [file for file in container.files() if file.lower().endswith(".csv")]
    if not files:
        raise RecordingSetError(container.path.name, f"holds no CSV; wanted {TRIALS_FILE} and one CSV per trial")
    return [TrialEntry(file, name_of(file), DEFAULT_KIND, {}) for file in files]


def _mapped(mapping: Mapping) -> list[TrialEntry]:
    source = "the mapping's [[trials]]"
    twice = [file for file, count in Counter(trial.file for trial in mapping.trials).items() if count > 1]
    if twice:
        raise RecordingSetError(source, f"'{twice[0]}' is listed twice; wanted each trial once")
    for trial in mapping.trials:
        check_name(trial.file, source)
        for name, value in trial.conditions.items():
            if problem := condition_problem(name, value):
                raise RecordingSetError(f"{source}, file '{trial.file}'", problem, column=name)
    return [TrialEntry(trial.file, name_of(trial.file), trial.kind, dict(trial.conditions)) for trial in mapping.trials]


def _table(container: Container, entry: TrialEntry, mapping: Mapping) -> Table:
    if not container.has(entry.file):
        tables = [file for file in container.files() if file.lower().endswith(".csv") and file != TRIALS_FILE]
        there = ", ".join(tables[:10])
        message = f"'{entry.file}' is not in the set; wanted one of its files (such as {there})"
        source = "the mapping's [[trials]]" if entry.line is None else place(container, TRIALS_FILE)
        raise RecordingSetError(source, message, entry.line, "file")
    return Table(container, entry.file, mapping.delimiter)


def _check_mapping_is_used(container: Container, mapping: Mapping, tables: Sequence[Table]) -> None:
    there = {name for table in tables for name in table.header}
    for channel, column in mapping.columns.items():
        if column.source not in there:
            message = f"the mapping takes {channel} from '{column.source}', which is in no CSV; they have "
            raise RecordingSetError(container.path.name, message + ", ".join(sorted(there)), column=column.source)


def _read(entry: TrialEntry, table: Table, mapping: Mapping) -> Recording:
    channels, events = read_recording_csv(table, mapping)
    rows = len(channels["time_s"])
    if entry.rows is not None and entry.rows != rows:
        message = f"has {rows} rows; {TRIALS_FILE}, line {entry.line}, says {entry.rows}. Is it cut off?"
        raise RecordingSetError(table.place, message)
    return Recording(entry.name, entry.kind, entry.conditions, channels, events)
