"""Read a recording set: a folder, a zip, or single files."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from bench.config.rig import Rig
from bench.recording_set.checks import check_recordings
from bench.recording_set.condition_columns import joined
from bench.recording_set.conditions import condition_problem
from bench.recording_set.container import Container, Files, check_name, open_container
from bench.recording_set.conversion import channels_of_table
from bench.recording_set.errors import RecordingSetError
from bench.recording_set.formats.column_table import ColumnTable
from bench.recording_set.formats.registry import BINARY_ENDINGS, check_readable, is_binary, read_table
from bench.recording_set.mapping import Mapping
from bench.recording_set.recording_csv import read_recording_csv
from bench.recording_set.recording_set import RecordingSet
from bench.recording_set.text.table import Table, place
from bench.recording_set.text.toml_file import MOST_BYTES, parse_toml
from bench.recording_set.trials_csv import (
    DEFAULT_KIND,
    TEXT_ENDINGS,
    TRIALS_FILE,
    TrialEntry,
    name_of,
    read_trials_csv,
)
from compensator.lab.recordings.recording import Recording
from compensator.lab.recordings.repeats import unlike_repeats

RIG_FILE = "rig.toml"
MAPPING_FILE = "mapping.toml"
TELL_ARM = "put the way from the axis to the load into the rig: [arm] length_m = 0.5, in m"
SourceTable = Table | ColumnTable


def read_recording_set(
    path: Path | Sequence[Path], mapping: Mapping | None = None, rig: Rig | None = None
) -> RecordingSet:
    """Read and check a whole recording set.

    Args:
        path: a folder, a zip of one, or single files, each a trial.
        mapping: for files of another shape; None takes the set's own mapping.toml, if it has one.
        rig: instead of the set's own rig.toml.

    Raises:
        RecordingSetError: naming file, line and column, what was found and what is wanted.
    """
    paths = [Path(one).absolute() for one in ([path] if isinstance(path, Path | str) else path)]
    with open_container(*paths) as container:
        own = mapping is None and container.has(MAPPING_FILE)
        mapping = mapping or own_mapping(container)
        entries = entries_of(container, mapping)
        tables = [table_of(container, entry, mapping) for entry in entries]
        if rig is None and (container.has(RIG_FILE) or not isinstance(container, Files)):
            rig = _read_rig(container)
        _check_mapping_is_used(container, mapping, tables)
        recordings = [_read(entry, table, mapping) for entry, table in zip(entries, tables, strict=True)]
        if rig is None:  # only now: nobody is to write one for a file that is no recording
            raise RecordingSetError(container.path.name, _without_rig(paths[0].parent))
        notes = [f"{place(container, MAPPING_FILE)}: the mapping that was used"] if own else []
        notes += [f"{table.place}: {table.told}" for table in tables if isinstance(table, Table) and table.told]
    check_recordings(recordings, rig, mapping)
    notes += [*_without_load(recordings), *_without_arm(recordings, rig), *_unlike(recordings)]
    return RecordingSet(name_of_set(paths), rig, recordings, tuple(notes))


def _without_rig(folder: Path) -> str:
    """That a single file has no rig, and where there is one."""
    beside = folder / RIG_FILE
    if beside.exists():
        return f"a single file has no rig; import {folder}, whose set it is of, or name --rig {beside}"
    return (
        "a single file has no rig; name one with --rig rig.toml. For files of another bench "
        "`friction-bench import --guess` writes it"
    )


def _without_load(recordings: Sequence[Recording]) -> list[str]:
    """Note of trials that do not tell their load: nothing that depends on it can be judged on them."""
    silent = [one.name for one in recordings if "load_kg" not in one.conditions]
    if not silent:
        return []
    which = (
        "no trial tells" if len(silent) == len(recordings) else f"{len(silent)} of {len(recordings)} trials do not tell"
    )
    remedy = (
        f"put it into {TRIALS_FILE}, or into the [[trials]] of a mapping (conditions = {{ load_kg = 0.1 }}); where a "
        'column of the files holds it, into [conditions] (load_kg = { from = "payload", unit = "g" })'
    )
    return [f"{which} load_kg: effects of the load are not judged; {remedy}"]


def _without_arm(recordings: Sequence[Recording], rig: Rig) -> list[str]:
    """Note of loads of which nobody tells where they hang: their moment counts as none."""
    loaded = [one for one in recordings if one.conditions.get("load_kg", 0.0) != 0.0]
    armless = [one.name for one in loaded if "arm_m" not in one.conditions]
    if not armless or rig.joint != "rotary" or rig.arm.length_m is not None:
        return []
    which = f"'{armless[0]}'" + (f" and {len(armless) - 1} more" if len(armless) > 1 else "")
    return [f"load_kg of {which} is told, and not where it hangs, so that its moment counts as none; {TELL_ARM}"]


def _unlike(recordings: Sequence[Recording]) -> list[str]:
    """Note of trials that are told as repeats, and do not move alike."""
    return [
        f"trials '{one.name}' and '{other.name}' are told as repeats of each other, and their motions differ "
        f"(correlation {found:.2f}): a study would take that for scatter. Tell motions apart by a condition, such as "
        'waveform = "slow sine"'
        for one, other, found in unlike_repeats(recordings)
    ]


def name_of_set(paths: Sequence[Path]) -> str:
    """The name of a set, told by where it is."""
    first = paths[0].absolute()  # a name without a folder before it is in one, too
    return first.parent.name if len(paths) > 1 else first.stem if first.is_file() else first.name


def own_mapping(container: Container) -> Mapping:
    """The mapping that a set brings along; one that changes nothing where it has none."""
    if not container.has(MAPPING_FILE):
        return Mapping()
    with container.open(MAPPING_FILE) as file:
        return parse_toml(file.read(MOST_BYTES + 1), Mapping, place(container, MAPPING_FILE))


def _read_rig(container: Container) -> Rig:
    if container.has(RIG_FILE):
        return read_rig_of(container)
    message = (
        'is not there; write one with at least: name = "...", or name a rig file of your own. For files of another '
        "bench `friction-bench import --guess` writes it, and POST /recording-sets/guess"
    )
    raise RecordingSetError(place(container, RIG_FILE), message)


def read_rig_of(container: Container) -> Rig:
    """The rig that a set brings along.

    Raises:
        RecordingSetError: no TOML, an unknown key or an impossible value; names file, line and key.
    """
    with container.open(RIG_FILE) as file:
        return parse_toml(file.read(MOST_BYTES + 1), Rig, place(container, RIG_FILE))


def entries_of(container: Container, mapping: Mapping) -> list[TrialEntry]:
    """The trials of a set, in its order.

    Raises:
        RecordingSetError: a list of trials that is wrong, or no table.
    """
    if container.has(TRIALS_FILE):
        if mapping.trials:
            message = "is there, and the mapping lists trials too; leave [[trials]] out of the mapping"
            raise RecordingSetError(place(container, TRIALS_FILE), message)
        return read_trials_csv(_text_table(container, TRIALS_FILE, mapping, numeric=False), mapping)
    if mapping.trials:
        return _mapped(mapping)
    files = _tables(container)
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


def _tables(container: Container) -> list[str]:
    """The files that hold trials: all that were named; of a folder, those whose ending says so."""
    files = [file for file in container.files() if file != TRIALS_FILE]
    if isinstance(container, Files):
        return files
    for endings in ((".csv", *BINARY_ENDINGS), TEXT_ENDINGS):  # a text file beside tables is a remark
        found = [file for file in files if file.lower().endswith(endings)]
        if found:
            return found
    for file in files:
        check_readable(container, file)
    return []


def table_of(container: Container, entry: TrialEntry, mapping: Mapping) -> SourceTable:
    """The table of a trial, of whatever format.

    Raises:
        RecordingSetError: not there, no table, or one that cannot be read.
    """
    if not container.has(entry.file):
        there = ", ".join(_tables(container)[:10])
        message = f"'{entry.file}' is not in the set; wanted one of its files (such as {there})"
        source = "the mapping's [[trials]]" if entry.line is None else place(container, TRIALS_FILE)
        raise RecordingSetError(source, message, entry.line, "file")
    check_readable(container, entry.file)
    if is_binary(entry.file):
        return read_table(container, entry.file)
    return _text_table(container, entry.file, mapping)


def _text_table(container: Container, file: str, mapping: Mapping, numeric: bool = True) -> Table:
    return Table(container, file, mapping.delimiter, mapping.decimal, mapping.encoding, numeric)


def _check_mapping_is_used(container: Container, mapping: Mapping, tables: Sequence[SourceTable]) -> None:
    there = {name for table in tables for name in table.header}
    wanted = {channel: column.sources for channel, column in mapping.columns.items()}
    wanted |= {name: (column.source,) for name, column in mapping.conditions.items()}
    for channel, sources in wanted.items():
        if missing := [name for name in sources if name not in there]:
            message = f"the mapping takes {channel} from '{missing[0]}', which is in no file; they have "
            raise RecordingSetError(container.path.name, message + ", ".join(sorted(there)), column=missing[0])


def _read(entry: TrialEntry, table: SourceTable, mapping: Mapping) -> Recording:
    if isinstance(table, Table):
        (channels, _, found), events = read_recording_csv(table, mapping)
    else:
        (channels, _, found), events = channels_of_table(table, mapping), []
    rows = len(channels["time_s"])
    if entry.rows is not None and entry.rows != rows:
        message = f"has {rows} rows; {TRIALS_FILE}, line {entry.line}, says {entry.rows}. Is it cut off?"
        raise RecordingSetError(table.place, message)
    conditions = joined(entry, found, table.place, mapping)
    return Recording(entry.name, entry.kind, conditions, channels, events)
